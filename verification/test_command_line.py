"""The command line for people and scripts: exit codes, messages, files.

Exit codes: 0 ok, 1 a limit is broken, 2 bad usage or input, 3 the computation failed.
"""

import os
import re
import shutil
import xml.etree.ElementTree

import h5py
import numpy
import pytest
from command_line import BLOCK, ROOT, dynamic, methods, sandglass

from common.result_file import text_of

CASES = sorted(file.stem for file in (ROOT / "cases").glob("*.toml"))


# Help, lists, usage.


@pytest.mark.parametrize(
    "words, texts",
    [
        (
            ["--help"],
            ["0 ok", "1 a limit is broken", "2 bad usage or input", "3 the computation failed"],
        ),
        (["--version"], ["sandglass "]),
        (
            ["run", "--describe"],
            ["material.poisson_ratio", "(-1, 0.5)", "[Pa]", "required", "dynamics.damping"]
            + ["default 1e-08"],
        ),
    ],
)
def test_the_program_describes_itself(words, texts):
    outcome = sandglass(*words, code=0)
    assert all(text in outcome.stdout for text in texts)


def test_cases_lists_every_case_with_its_requirement():
    outcome = sandglass("cases", code=0)
    lines = outcome.stdout.splitlines()
    assert sorted(line.split()[0] for line in lines) == CASES
    assert any(line.startswith("bending ") and "12 variants" in line for line in lines)
    assert all(line.endswith(".") for line in lines)


def test_cases_in_an_empty_or_missing_folder(tmp_path):
    environment = dict(os.environ, SANDGLASS_CASES=str(tmp_path / "none"))
    sandglass("cases", env=environment, code=2, message="none: cannot list the cases")


def test_methods_lists_one_line_each():
    outcome = sandglass("methods", code=0)
    assert {"tl-none", "tl-perturbation", "tl-full", "tl-mean-dilatation"} <= set(methods())
    assert all(len(line.split()) > 3 for line in outcome.stdout.splitlines())


# Wrong input.


def test_a_variant_is_named_after_its_file(tmp_path):
    file = tmp_path / "other.toml"
    shutil.copy(ROOT / "cases" / "bending.toml", file)
    first = re.search(r"as in (\S+)$", sandglass("run", file, code=2).stderr.strip())[1]
    assert first.startswith(f"{file}/bending-")
    assert sandglass("run", first, code=0).stdout.startswith(f"{first.rpartition('/')[2]}: ")
    sandglass("run", file / "bending-9", code=2, message=["has no variant 'bending-9'; it has"])


def test_variant_is_found_by_name_and_beside_its_file(tmp_path):
    shutil.copy(ROOT / "cases" / "bending.toml", tmp_path / "bending.toml")
    for name in ("bending-2-nu0.25", tmp_path / "bending-2-nu0.25"):
        outcome = sandglass("mesh", name, "-o", tmp_path / "mesh.h5", code=0)
        assert "99 nodes, 40 elements" in outcome.stdout


# Runs.


def test_run_writes_what_it_says(block):
    result = block.parent / "result.h5"
    outcome = sandglass("run", block, "-o", result, code=0)
    assert f"wrote {result}; open {result.with_suffix('.xdmf')} in ParaView" in outcome.stdout
    assert sorted(file.name for file in block.parent.iterdir()) == [
        "block.toml",
        "result.h5",
        "result.xdmf",
    ]
    with h5py.File(result) as file:
        assert file["mesh/points"].shape == (45, 3)
        assert file["mesh/cells"].shape == (16, 8)
        assert sorted(file["mesh/sets"]) == ["foot", "head"]
        for name in (
            "case_hash",
            "mesh_hash",
            "revision",
            "build_flags",
            "compiler",
            "method",
            "kappa",
            "status",
            "stability",
        ):
            assert file.attrs[name]
        assert text_of(file.attrs["method"]) == "tl-perturbation"
        assert text_of(file.attrs["status"]) == "complete"
        frames = sorted(file["frames"])
        times = [file["frames"][frame].attrs["time"] for frame in frames]
        assert times[0] == 0.0 and times == sorted(set(times))
        assert not file["frames/0000/displacement"][:].any()
        last = file["frames"][frames[-1]]["displacement"][:]
        head = file["mesh/sets/head"][:]
        assert numpy.array_equal(last[head], numpy.tile([0.02, 0.0, 0.01], (len(head), 1)))
        assert file["history/residual"][-1] < 1e-8
        rows = len(file["history/time"])
        columns = [file["history"][name] for name in file["history"] if name != "reaction"]
        assert {column.shape for column in columns} == {(rows,)}
        assert {force.shape for force in file["history/reaction"].values()} == {(rows, 3)}


@pytest.mark.parametrize("method", methods())
def test_every_method_runs(block, method):
    # A control that resists only velocities allows static zigzags: no equilibrium is found.
    assert sandglass("run", block, "--method", method).returncode == (
        3 if "viscous" in method else 0
    )


def test_kappa_given_is_kappa_used(block):
    energies = []
    for kappa in ("0", "0.1"):
        result = block.parent / "result.h5"
        assert sandglass("run", block, "--kappa", kappa, "-o", result).returncode == 0
        with h5py.File(result) as file:
            assert text_of(file.attrs["kappa"]) == kappa
            energies.append(file["history/hourglass_energy"][-1])
    assert energies[0] == 0.0 and energies[1] > 0.0


def test_xdmf_points_into_the_result(block):
    result = block.parent / "result.h5"
    assert sandglass("run", block, "-o", result).returncode == 0
    root = xml.etree.ElementTree.parse(block.parent / "result.xdmf").getroot()
    grids = root.findall("./Domain/Grid/Grid")
    with h5py.File(result) as file:
        assert len(grids) == len(file["frames"])
        for frame, grid in zip(sorted(file["frames"]), grids):
            time_value = float(grid.find("Time").attrib["Value"])
            assert time_value == pytest.approx(file["frames"][frame].attrs["time"], rel=1e-15)
            assert {a.attrib["Name"].split(" [")[0] for a in grid.findall("Attribute")} == {
                "displacement",
                "velocity",
                "jacobian",
                "hourglass energy density",
                "stress",
                "reaction at foot",
                "reaction at head",
            }
            items = list(grid.iter("DataItem"))
            assert len(items) == 9  # cells, points, five fields, two forces
            for item in items:
                name, path = item.text.split(":")
                assert name == "result.h5"
                shape = tuple(int(n) for n in item.attrib["Dimensions"].split())
                assert file[path].shape == shape
                assert file[path].dtype.itemsize == int(item.attrib["Precision"])
                assert (file[path].dtype.kind == "f") == (item.attrib["NumberType"] == "Float")
            assert all(f"/{frame}/" in a.find("DataItem").text for a in grid.findall("Attribute"))
            topology = grid.find("Topology").attrib
            assert (
                topology["TopologyType"] == "Hexahedron" and int(topology["NumberOfElements"]) == 16
            )


def test_mesh_writes_mesh_and_sets(tmp_path):
    outcome = sandglass("mesh", "ellipsoid-touch", "-o", tmp_path / "mesh.h5", code=0)
    assert "2535 nodes, 2200 elements" in outcome.stdout
    assert [file.name for file in tmp_path.iterdir()] == ["mesh.h5"]
    with h5py.File(tmp_path / "mesh.h5") as file:
        assert file["mesh/points"].shape == (2535, 3)
        assert file["mesh/cells"].shape == (2200, 8)
        assert len(file["mesh/sets/support"]) == 141
        assert len(file["mesh/sets/indenter"]) == 65


def test_dynamic_case(block):
    block.write_text(dynamic(BLOCK, duration=0.05, frames=5))
    result = block.parent / "result.h5"
    assert sandglass("run", block, "-o", result).returncode == 0
    with h5py.File(result) as file:
        times = [frame.attrs["time"] for frame in file["frames"].values()]
        assert len(times) == 6 and times[0] == 0.0 and times[-1] == pytest.approx(0.05, rel=1e-9)
        assert file["history/kinetic_energy"][:].max() > 0.0
    sandglass("verify", block, code=2, message="dynamic")


def test_run_reports_its_subcycles(block):
    bar = BLOCK.replace("[0.1, 0.1, 0.2]", "[0.05, 0.05, 20.0]").replace("[2, 2, 4]", "[1, 1, 400]")
    bar = bar.replace("[0.2, 0.2]", "[20.0, 20.0]")
    end = '[element_sets]\nend = { z = [0.0, 0.05] }\n[[refine]]\nelements = "end"\ndepth = 2\n'
    for text, most, message in [
        (bar + end, 16, ", 4 subcycles, complete"),
        (bar + end, 2, ", 2 subcycles, complete"),
        (bar, 16, ", 1 subcycle, complete"),
        (bar + end, 1, "s, complete"),
    ]:
        block.write_text(dynamic(text, duration=0.1, subcycles=most))
        outcome = sandglass("run", block, code=0)
        assert message in outcome.stdout
        assert ("subcycle" in outcome.stdout) == (most > 1)
    block.write_text(dynamic(bar, duration=0.1, subcycles=65))
    sandglass("run", block, code=2, message="dynamics.subcycles = 65")


# Failures of the computation.


def test_inversion_ends_with_3_and_keeps_the_way_there(block):
    text = BLOCK.replace("[2, 2, 4]", "[2, 2, 1]").replace("[0.02, 0.0, 0.01]", "[0.0, 0.0, -0.3]")
    block.write_text(text)
    outcome = sandglass("run", block, "-o", block.parent / "result.h5", code=3)
    assert "det F" in outcome.stderr
    assert "remedy" in outcome.stderr
    assert "the last equilibrium is at 0." in outcome.stderr
    with h5py.File(block.parent / "result.h5") as file:
        assert text_of(file.attrs["status"]) == "failed"
        assert len(file["frames"]) > 1


def test_no_equilibrium_ends_with_3_and_says_so_in_the_file(block):
    block.write_text(BLOCK + "[relaxation]\nmax_steps = 5\n")
    result = block.parent / "result.h5"
    sandglass("run", block, "-o", result, code=3, message="no equilibrium after 5 evaluations")
    with h5py.File(result) as file:
        assert text_of(file.attrs["status"]) == "no equilibrium after 5 evaluations"


def test_cases_folder_is_found_from_anywhere(tmp_path):
    shutil.copy(ROOT / "cases" / "column.toml", tmp_path / "mine.toml")
    environment = dict(os.environ, SANDGLASS_CASES=str(tmp_path))
    assert "column" in sandglass("cases", env=environment).stdout
    assert (
        sandglass("mesh", "mine", "-o", tmp_path / "m.h5", env=environment, cwd=tmp_path).returncode
        == 0
    )
