"""Entries are scored again: all stored ones are confirmed, wrong ones are refused with a reason."""

import json
import shutil

import h5py
import numpy as np
import pytest

from common.errors import InputError
from common.program import binary, output_of
from common.result_file import last_displacement
from results import check, submit
from results.entry import FOLDER, entry_files, hash_of, read_entry

STRANGER = {
    "--case": "column",
    "--program": "My FEM",
    "--version": "1.2",
    "--element": "Q1P0",
    "--precision": "double",
    "--build": "GCC 12, -O3",
    "--machine": "AMD EPYC, one thread",
    "--ns": "50",
    "--step": "1e-3",
    "--seconds": "2",
    "--by": "A. Stranger",
}


@pytest.mark.parametrize("name", [path.name for path in entry_files()])
def test_stored_entries_match_the_scores_of_their_displacements(name):
    check.check(FOLDER / name)


def test_every_stored_displacement_belongs_to_an_entry():
    stored = {path.stem for path in (FOLDER / "displacements").glob("*.h5")}
    assert stored == {read_entry(path)["displacement"] for path in entry_files()}


@pytest.fixture(scope="module")
def answer(tmp_path_factory):
    """A file as another program could write it: nodes in another order, with their coordinates."""
    folder = tmp_path_factory.mktemp("answer")
    output_of(binary(), "run", "column", "-m", "tl-full", "-o", folder / "result.h5")
    with h5py.File(folder / "result.h5") as file:
        points = file["mesh/points"][...]
    table = np.column_stack([points, last_displacement(folder / "result.h5")])[::-1]
    path = folder / "answer.csv"
    rows = [",".join(map(repr, row)) for row in table.tolist()]
    path.write_text("\n".join(["x,y,z,ux,uy,uz", *rows]) + "\n")
    return path


def submitted(answer, folder, **changed):
    """The exit code, and the path of a stranger's entry; options that are None are left out."""
    options = (STRANGER | changed).items()
    words = [word for pair in options for word in pair if None not in pair]
    code = submit.main([str(answer), *words, "--folder", str(folder)])
    return code, next(iter(entry_files(folder)), None)


def test_a_stranger_submits(answer, tmp_path, capsys):
    code, path = submitted(answer, tmp_path)
    assert code == 0 and f"wrote {path}" in capsys.readouterr().out
    entry = read_entry(path)
    assert (entry["program"], entry["submitted_by"]) == ("My FEM", "A. Stranger")
    assert (entry["ns_per_element_step"], entry["time_step"]) == (50.0, 1e-3)
    # The displacement element locks: 1.8 % from the golden, as in exchange/README.md.
    assert entry["errors"]["golden"]["max"] == pytest.approx(0.018, rel=0.01)
    assert check.main([str(path)]) == 0


def spoil_displacement(path, entry):
    """Stores other displacements under their own hash."""
    stored = path.parent / "displacements" / f"{entry['displacement']}.h5"
    with h5py.File(stored, "r+") as file:
        file["displacement"][7, 0] += 1e-3
    entry["displacement"] = hash_of(stored.read_bytes())
    stored.rename(stored.with_stem(entry["displacement"]))


def spoil_file(path, entry):
    """Stores other displacements under the old hash."""
    stored = path.parent / "displacements" / f"{entry['displacement']}.h5"
    with h5py.File(stored, "r+") as file:
        file["displacement"][7, 0] += 1e-3


def lose_file(path, entry):
    """Removes the displacements."""
    shutil.rmtree(path.parent / "displacements")


def claim_less(path, entry):
    """Claims a smaller error."""
    entry["errors"]["golden"]["max"] /= 2


def omit_one_reference(path, entry):
    """Leaves out the errors to the truth."""
    del entry["errors"]["truth"]


def name_another_mesh(path, entry):
    """Claims another mesh."""
    entry["mesh_hash"] = "0" * 16


def break_schema(path, entry):
    """Has an invalid time."""
    entry["time_step"] = -1.0


@pytest.mark.parametrize(
    "spoil, message",
    [
        (spoil_displacement, "errors.golden.rms = .*: its displacements score"),
        (spoil_file, "has another SHA-256: it was changed"),
        (lose_file, "is not in displacements/"),
        (claim_less, "errors.golden.max = .*: its displacements score"),
        (omit_one_reference, "errors: those to golden, truth are required"),
        (name_another_mesh, "mesh_hash: the mesh of column is"),
        (break_schema, "time_step: -1.0 is less than"),
    ],
)
def test_wrong_entries_are_refused(answer, tmp_path, capsys, spoil, message):
    _, path = submitted(answer, tmp_path)
    entry = json.loads(path.read_text())
    spoil(path, entry)
    path.write_text(json.dumps(entry))
    with pytest.raises(InputError, match=message):
        check.check(path)
    assert check.main([str(path)]) == 1
    assert capsys.readouterr().err.startswith(f"error: {path}: ")


@pytest.mark.parametrize(
    "changed, message",
    [
        ({"--case": None}, "missing: --case"),
        ({"--case": "colunm"}, "did you mean 'column'"),
        ({"--ns": "-1"}, "ns_per_element_step: -1.0 is less than"),
    ],
)
def test_wrong_submissions(answer, tmp_path, capsys, changed, message):
    assert submitted(answer, tmp_path, **changed) == (2, None)
    assert message in capsys.readouterr().err


def test_nodes_that_are_not_those_of_the_case(answer, tmp_path, capsys):
    other = tmp_path / "other.csv"
    lines = answer.read_text().splitlines()
    other.write_text("\n".join(lines[:-1]) + "\n")
    assert submitted(other, tmp_path) == (2, None)
    assert "nodes of the case have no node" in capsys.readouterr().err


def test_entries_of_a_comparison(answer, tmp_path):
    """Static and dynamic rows of the same program, build, element and precision form one entry."""
    shared = {"element": "H8", "precision": "float", "failure": None}
    rival = shared | {"program": "NiftySim", "build": "native"}
    own = shared | {"program": "Sandglass", "build": "", "element": "tl-full"}
    more = {"seconds": 2.0, "steps": 7, "solve": "damped motion", "time_step": 1e-3}
    more["answer"] = answer.name
    near = {"method": "tl-perturbation", "difference": 0.01}
    document = {
        "case": "column",
        "processor": "CPU",
        "sandglass": "0.1",
        "build": "GNU",
        "programs": [
            {"name": "NiftySim", "build": "native", "version": "", "about": "2.5; GCC -O3"}
        ],
        "static": [
            rival | more,
            own | more,
            rival | more | {"element": "H9", "failure": "diverged"},
        ],
        "in_motion": [
            rival | {"ns_per_element_step": 40.0, "nearest": near},
            own | {"ns_per_element_step": 4.0},
        ],
    }
    peers = tmp_path / "peers.json"
    peers.write_text(json.dumps(document))
    folder = tmp_path / "results"
    folder.mkdir()
    words = ["--peers", str(peers), "--answers", str(answer.parent), "--by", "us"]
    assert submit.main([*words, "--folder", str(folder)]) == 0
    entries = {e["program"]: e for e in map(read_entry, entry_files(folder))}
    assert set(entries) == {"NiftySim", "Sandglass"}
    found = entries["NiftySim"]
    assert (found["version"], found["build"]) == ("2.5", "native, GCC -O3")
    assert (found["ns_per_element_step"], found["seconds_to_rest"]) == (40.0, 2.0)
    assert found["nearest_motion"] == near and "nearest_motion" not in entries["Sandglass"]
    assert entries["Sandglass"]["version"] == "0.1" and entries["Sandglass"]["build"] == "GNU"
