"""The solver with files of other programs: exit codes, messages, bit-identical answers."""

import os
import resource
import shutil
import xml.etree.ElementTree as xml

import h5py
import numpy as np
import pytest
from command_line import BLOCK, documented, dynamic, sandglass, write_golden
from meshes import CELLS, DATA, POINTS, write

from common.accuracy import relative_errors  # an account of its own
from common.result_file import last_displacement, text_of

FILE_MESH = '[mesh]\nfile = "{}"\n'
GENERATED = BLOCK[BLOCK.index("[mesh]") : BLOCK.index("[material]")]
SETS = BLOCK[BLOCK.index("[sets]") : BLOCK.index("[[displacement]]")]
MASKS = {name: (POINTS[:, 2] == z).astype(int) for name, z in (("foot", 0), ("head", 2))}
LARGEST = np.hypot(0.02, 0.01)  # of the displacements that BLOCK imposes, m


def case_of(folder, mesh, name="own.toml"):
    """The case BLOCK on a mesh file, which brings the sets."""
    text = BLOCK.replace(GENERATED, FILE_MESH.format(mesh)).replace(SETS, "")
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def refused(*arguments, message, **options):
    """One line of error, an exit code of 2."""
    done = sandglass(*arguments, **options, code=2)
    lines = done.stderr.splitlines()
    assert len(lines) == 1 and lines[0].startswith("error: ") and message in lines[0], done.stderr
    assert "sandglass-" not in done.stderr, "a temporary file is nobody's business"


@pytest.mark.parametrize("ending", ["vtu", "inp", "h5"])
def test_a_mesh_that_goes_round_gives_the_same_answer(block, ending):
    folder = block.parent
    sandglass("mesh", block, "-o", folder / f"own.{ending}", code=0)
    own = case_of(folder, f"own.{ending}")
    hashes = []
    for case, result in ((block, "a.h5"), (own, "b.h5")):
        sandglass("run", case, "-o", folder / result, code=0)
        with h5py.File(folder / result) as file:
            hashes.append(text_of(file.attrs["mesh_hash"]))
    assert hashes[0] == hashes[1], "nodes, elements and sets are the same to the bit"
    assert (last_displacement(folder / "a.h5") == last_displacement(folder / "b.h5")).all()


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"cells": CELLS + 0.7}, "dataset '/mesh/cells' must hold integers"),
        ({"sets/foot": [0.0, 1.0, 2.0, 3.7]}, "dataset '/mesh/sets/foot' must hold integers"),
        ({"sets/foot": MASKS["foot"]}, "/mesh/sets/foot lists node 0 more than once"),
        (
            {"cells": [*CELLS, CELLS[0]]},
            "elements 0 and 2 lie on the same side of their common face",
        ),
        (
            {"cells": [CELLS[0]] * 2, "points": POINTS[:8], "sets/head": [4, 5, 6, 7]},
            "elements 0 and 1 lie on the same side",
        ),
        # The same element that begins at another corner.
        (
            {"cells": [*CELLS, np.roll(CELLS[0].reshape(2, 4), 1, 1).ravel()]},
            "elements 0 and 2 lie",
        ),
    ],
)
def test_a_file_of_our_own_form_that_would_be_misread(tmp_path, changes, message):
    sets = {f"sets/{name}": np.flatnonzero(mask) for name, mask in MASKS.items()}
    with h5py.File(tmp_path / "own.h5", "w") as file:
        for name, data in ({"points": POINTS, "cells": CELLS} | sets | changes).items():
            file["mesh/" + name] = data
    refused("run", case_of(tmp_path, "own.h5"), message=message)


@pytest.mark.parametrize(
    "mesh", ["block-2.2.msh", "block-4.1.msh", "block-4.1-binary.msh", "block.inp"]
)
def test_meshes_of_gmsh_run(tmp_path, mesh):
    shutil.copy(DATA / mesh, tmp_path)
    case = case_of(tmp_path, mesh)
    head = "head_plate" if mesh.endswith("inp") else "head plate"
    case.write_text(case.read_text().replace('set = "head"', f'set = "{head}"'))
    assert (
        "static equilibrium (stable):"
        in sandglass("run", case, "-o", tmp_path / "a.h5", code=0).stdout
    )
    with h5py.File(tmp_path / "a.h5") as file:
        points = file["mesh/points"][...]
    u = last_displacement(tmp_path / "a.h5")
    assert (u[points[:, 2] == 0.2] == [0.02, 0, 0.01]).all() and (u[points[:, 2] == 0] == 0).all()
    assert "surface-77" in sandglass("mesh", case, "-o", tmp_path / "m.h5").stdout or "inp" in mesh


def test_rules_of_the_case_add_sets_to_those_of_the_file(block):
    folder = block.parent
    sandglass("mesh", block, "-o", folder / "own.vtu", code=0)
    own = case_of(folder, "own.vtu")
    sets = "[sets]\nmiddle = { z = [0.1, 0.1] }\nfoot = { z = [0, 0.05] }\n"
    own.write_text(own.read_text() + sets)
    said = sandglass("mesh", own, "-o", folder / "m.h5", code=0).stdout
    for line in ("set middle: 9 nodes", "set head: 9 nodes", "set foot: 18 nodes"):
        assert line in said


def test_corrections_are_reported_and_the_run_continues(tmp_path):
    mirrored = CELLS[:, [4, 5, 6, 7, 0, 1, 2, 3]]
    write(tmp_path / "own.vtu", POINTS / 20, mirrored, point_data=MASKS)
    done = sandglass("run", case_of(tmp_path, "own.vtu"), code=0)
    message = f"warning: {tmp_path}/own.vtu: 2 of 2 elements had a mirrored node order"
    assert done.stderr.startswith(message)
    assert "static equilibrium (stable):" in done.stdout


def test_files_that_are_no_mesh(tmp_path):
    case = case_of(tmp_path, "own.msh")
    output = ["-o", tmp_path / "out.h5"]
    message = f"{case}: mesh.file: {tmp_path}/own.msh: cannot be read: No such"
    refused("run", case, *output, message=message)
    (tmp_path / "own.geo").touch()
    message = f"; `gmsh -3 {tmp_path}/own.geo -o {tmp_path}/own.msh` makes"
    refused("run", case, *output, message=message)
    (tmp_path / "own.geo").unlink()
    (tmp_path / "own.msh").write_bytes((DATA / "block-4.1.msh").read_bytes()[:1500])
    for command in ("run", "mesh"):
        refused(
            command, case, *output, message="own.msh:43: $Nodes has no $EndNodes: the file is cut"
        )
    refused("verify", case, message="own.msh:43: $Nodes has no $EndNodes")
    tetrahedra = write(tmp_path / "own.vtu", cells=[[0, 1, 2, 4]], kind="tetra")
    case = case_of(tmp_path, tetrahedra.name)
    refused("run", case, *output, message="1 of type 'tetra', besides 0 hex")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["own.msh", "own.toml", "own.vtu"]


def test_a_file_whose_name_looks_like_an_option(tmp_path):
    case_of(tmp_path, "-o.msh")
    message = "own.toml: mesh.file: -o.msh: cannot be read: No such file"
    refused("run", "own.toml", message=message, cwd=tmp_path)


def test_a_set_that_the_file_lacks(tmp_path):
    shutil.copy(DATA / "block-4.1.msh", tmp_path)
    case = case_of(tmp_path, "block-4.1.msh")
    refused("run", case, message="'head' is not a node set of this case; ")


def test_a_file_without_sets(tmp_path):
    write(tmp_path / "own.vtu")
    message = "'foot' is not a node set of this case, which has none: [sets] gives rules for them"
    refused("run", case_of(tmp_path, "own.vtu"), message=message)


def test_a_file_of_another_kind_and_a_misspelt_key(tmp_path):
    (tmp_path / "own.geo").touch()
    case = case_of(tmp_path, "own.geo")
    refused("run", case, message="own.geo: is not a complete HDF5 file (truncated, or of another")
    refused("run", case, message="must end in .msh (Gmsh), .inp (Abaqus), .vtu, .vtk, .npy or .nii")
    case.write_text(case.read_text().replace("file =", "fiel ="))
    message = (
        "mesh.generator is missing; this key, mesh.file or [[mesh.bodies]] must be given, but "
        "there is only fiel"
    )
    refused("run", case, message=message)


@pytest.mark.parametrize(
    "variable, value, message",
    [
        ("SANDGLASS_PYTHON", "/no/python3", "/no/python3: cannot be run: No such file or dir"),
        ("SANDGLASS_EXCHANGE", "/no/exchange", "/no/exchange/convert.py: is missing"),
        ("PYTHONPATH", "meshio", "meshio is not installed; files of other programs need packages "),
        ("PYTHONPATH", "h5py", "h5py is not installed; files of other programs need packages "),
    ],
)
def test_missing_programs_are_named(tmp_path, variable, value, message):
    write(tmp_path / "own.vtu", point_data=MASKS)
    if variable == "PYTHONPATH":
        (tmp_path / f"{value}.py").write_text(f"raise ImportError(name={value!r})\n")
        value = str(tmp_path)
    environment, output = dict(os.environ, **{variable: value}), tmp_path / "out.vtu"
    refused("mesh", case_of(tmp_path, "own.vtu"), "-o", output, message=message, env=environment)


def test_a_converter_that_dies(tmp_path):
    write(tmp_path / "own.vtu")
    (tmp_path / "convert.py").write_text("import os\nos.abort()\n")
    environment = dict(os.environ, SANDGLASS_EXCHANGE=str(tmp_path))
    done = sandglass("run", case_of(tmp_path, "own.vtu"), env=environment, code=3)
    assert "own.vtu: cannot be completed: convert.py was ended by" in done.stderr


@pytest.mark.parametrize("ending", ["vtu", "xdmf", "inp"])
@pytest.mark.parametrize("size", [0, 4096 * 5])
def test_a_full_disk_leaves_the_old_file(block, ending, size):
    """The second has room for the mesh on its way to the converter, not for what that writes."""
    block.write_text(BLOCK.replace("[2, 2, 4]", "[6, 6, 12]"))
    folder = block.parent
    (folder / f"own.{ending}").write_text("good")
    limit = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))}
    done = sandglass("mesh", block, "-o", f"own.{ending}", cwd=folder, **limit, code=3)
    assert "File too large" in done.stderr
    assert sorted(file.name for file in folder.iterdir()) == ["block.toml", f"own.{ending}"]
    assert (folder / f"own.{ending}").read_text() == "good"


def test_a_motion_with_a_rotation_or_a_mass_has_no_deck(block):
    turned = '[[rotation]]\nset = "head"\naxis = "z"\nangle = 9.0\n'
    text = BLOCK[: BLOCK.rindex("[[displacement]]")] + turned
    words = "-o", block.parent / "a.xml", "--deck", "niftysim"
    block.write_text(dynamic(text, duration=0.05))
    refused("mesh", block, *words, message="a deck cannot hold rotations of a dynamic case")
    block.write_text(dynamic(BLOCK + '[[mass]]\nset = "head"\ntotal = 1.0\n', duration=0.05))
    refused("mesh", block, *words, message="a deck cannot hold masses of a dynamic case")


def test_a_deck_of_a_motion_says_how_it_moves(block):
    block.write_text(dynamic(BLOCK, duration=0.05, time_step=1e-3, damping=3.0))
    deck = block.parent / "a.xml"
    sandglass("mesh", block, "--deck", "niftysim", "--hourglass", "0.25", "-o", deck, code=0)
    parameters = xml.parse(deck).getroot().find("SystemParams")
    found = {one.tag: float(one.text) for one in parameters}
    assert found == {
        "TimeStep": pytest.approx(1e-3),
        "TotalTime": pytest.approx(0.05),
        "DampingCoeff": 3.0,
        "HGKappa": 0.25,
        "Density": 1000.0,
    }


def test_decks_that_cannot_be(block):
    folder, words = block.parent, ["-o", "a.inp", "--deck", "calculix"]
    block.write_text(BLOCK.replace('law = "neo-hookean"', 'law = "st-venant-kirchhoff"'))
    message = "law = 'st-venant-kirchhoff' is not known to CalculiX"
    refused("mesh", block, *words, message=message, cwd=folder)
    block.write_text(dynamic(BLOCK, duration=0.05))
    message = "a dynamic case has no answer to score"
    refused("score", "a.csv", "--case", block, message=message, cwd=folder)
    assert [file.name for file in folder.iterdir()] == ["block.toml"]


def test_a_deck_says_what_the_case_says(block):
    block.write_text(BLOCK + '[[force]]\nset = "side"\ntotal = [0.0, 0.5, 0.0]\n')
    block.write_text(block.read_text().replace("[sets]", "[sets]\nside = { x = [0.1, 0.1] }"))
    deck = block.parent / "deck.inp"
    sandglass("mesh", block, "--deck", "calculix", "--element", "C3D8R", "-o", deck, code=0)
    text = deck.read_text()
    assert text.startswith("*HEADING\nblock, mesh ") and "*ELEMENT, TYPE=C3D8R, ELSET=ALL" in text
    assert "*NSET, NSET=foot\n1, 2, 3, 4, 5, 6, 7, 8, 9\n" in text
    lines = text[text.index("*BOUNDARY") : text.index("*NODE FILE")].splitlines()
    cut = lines.index("*CLOAD")
    imposed = {tuple(line.split(", ")[:2]): line.split(", ")[3] for line in lines[1:cut]}
    assert len(imposed) == 2 * 9 * 3
    assert {imposed[node, "1"] for node in ("37", "45")} == {"0.02"}
    assert {imposed[node, "3"] for node in ("37", "45")} == {"0.01"}
    forces = [line.split(", ") for line in lines[cut + 1 :]]
    # Of a load that is the same everywhere: a sixteenth and an eighth of it at the nodes of an end.
    assert {axis for _, axis, _ in forces} == {"2"} and len(forces) == 15
    assert abs(sum(float(force) for _, _, force in forces) - 0.5) < 1e-15


def test_a_deck_ends_where_a_rotation_ends(block):
    turned = '[[rotation]]\nset = "head"\naxis = "z"\nangle = 90.0\n'
    turned += "displacement = [0.0, 0.0, 0.01]\n"
    block.write_text(BLOCK[: BLOCK.rindex("[[displacement]]")] + turned)
    sandglass("mesh", block, "--deck", "calculix", "-o", block.parent / "a.inp", code=0)
    lines = (block.parent / "a.inp").read_text().splitlines()
    points = [line.split(", ")[1:] for line in lines[3:48]]
    end = lines.index(next(n for n in lines if "FILE" in n))
    boundary = lines[lines.index("*BOUNDARY") + 1 : end]
    u = np.full((45, 3), np.nan)
    for node, axis, _, value in (line.split(", ") for line in boundary):
        u[int(node) - 1, int(axis) - 1] = float(value)
    x, y, z = np.array(points, dtype=float).T
    exact = np.stack([(0.05 - y) + (0.05 - x), (x - 0.05) + (0.05 - y), 0 * z + 0.01], axis=1)
    assert (u[z == 0] == 0).all() and np.isnan(u[(z > 0) & (z < 0.2)]).all()
    assert np.allclose(u[z == 0.2], exact[z == 0.2], rtol=0, atol=1e-16)


# Scores.


@pytest.fixture
def answered(block):
    """BLOCK with a golden, and the answer of tl-perturbation in answer.h5."""
    write_golden(block)
    sandglass("run", block, "-o", block.parent / "answer.h5", code=0)
    return block


def scored(case, answer, *options):
    """The record that a score leaves."""
    _, document = documented("score", answer, "--case", case, *options, code=0)
    assert document["limits"] == [] and "revision" in document
    (record,) = document["records"]
    return record


def test_a_score_has_the_figures_of_verify(answered):
    record = scored(answered, answered.parent / "answer.h5", "--name", "mine")
    runs = documented("verify", answered, code=0)[1]["records"]
    (run,) = [r for r in runs if r["method"] == "tl-perturbation" and r["kappa_is_auto"]]
    assert record["golden"] == run["golden"] and record["golden"]["max_relative_error"] > 1e-3
    assert record["truth"] is None and record["finding"] == run["finding"]
    assert (record["case"], record["method"], record["status"]) == ("block", "mine", "ok")
    assert set(record) == set(run), "it is a record of verify"


def test_a_score_is_that_of_another_account(answered):
    """Nodes shuffled, in a table; the reference's own figures of the same displacements."""
    folder, random = answered.parent, np.random.default_rng(1)
    with h5py.File(folder / "answer.h5") as file:
        points = file["mesh/points"][...]
    with h5py.File(folder / "golden.h5") as file:
        golden = file["displacement"][...]
    u = random.normal(scale=1e-3, size=points.shape)
    order = random.permutation(len(points))
    rows = np.column_stack([points, u])[order].tolist()
    lines = ["x,y,z,ux,uy,uz"] + [",".join(map(repr, row)) for row in rows]
    (folder / "table.csv").write_text("\n".join(lines))
    figures = scored(answered, folder / "table.csv")["golden"]
    expected = relative_errors(u, golden, LARGEST)
    found = figures["max_relative_error"], figures["rms_relative_error"]
    assert np.allclose(found, expected, rtol=1e-12)  # sums of squares in another order
    assert figures["profile_relative_error"] is None


def test_the_golden_is_its_own_best_answer(answered):
    with h5py.File(answered.parent / "golden.h5") as golden:
        with h5py.File(answered.parent / "mine.h5", "w") as mine:
            mine["displacement"] = golden["displacement"][...]  # by row, with nothing else
    record = scored(answered, answered.parent / "mine.h5")
    assert record["golden"]["max_relative_error"] == 0 and record["finding"] == "good"
    assert record["method"] == "mine"


def test_without_a_golden_the_mean_dilatation_element_judges(answered):
    """Its answer equals another run's bit for bit: both end at the same residual."""
    folder = answered.parent
    with h5py.File(folder / "golden.h5") as file:
        mean_dilatation = file["displacement"][...]
    (folder / "golden.h5").unlink()
    record = scored(answered, folder / "answer.h5")
    assert record["golden"] is None and record["finding"] is None
    expected = relative_errors(last_displacement(folder / "answer.h5"), mean_dilatation, LARGEST)
    assert np.isclose(record["twin"]["max_relative_error"], expected[0], rtol=1e-12)
    said = sandglass("score", folder / "answer.h5", "--case", answered, code=0).stdout
    assert "against the mean-dilatation element" in said and "against the truth" not in said


@pytest.mark.parametrize(
    "words, message",
    [
        (["none.vtu"], "none.vtu: cannot be read: No such file"),
        (["block.toml"], "block.toml: ending '.toml'; allowed are .csv, .frd, .h5"),
        (["answer.h5", "--tolerance", "0"], "--tolerance = 0 must be in (0, 1)"),
        (["answer.h5", "--name", "a/b"], "--name must have no '/'"),
        (["answer.h5", "--json", "none/a.json"], "none/a.json: cannot be written"),
        (["golden.h5", "--case", "column"], "45 rows must be 0 to 495 or 1 to 496"),
        (["answer.h5", "--case", "column"], "nodes of the case have no node of the file within"),
    ],
)
def test_wrong_ways_to_score(answered, words, message):
    case = [] if "--case" in words else ["--case", "block.toml"]
    refused("score", *words, *case, message=message, cwd=answered.parent)
    assert (answered.parent / "answer.h5").stat().st_size > 1000


def test_quality_table(tmp_path):
    """Two cubes, the upper one leaning by 60 degrees: its scaled Jacobian is that cosine."""
    points = POINTS + np.sqrt(3) * np.maximum(POINTS[:, 2:] - 1, 0) * [1, 0, 0]
    write(tmp_path / "own.vtu", points, point_data=MASKS)
    said = sandglass("mesh", case_of(tmp_path, "own.vtu"), "-o", tmp_path / "m.h5", code=0).stdout
    assert "smallest scaled Jacobian 0.500" in said
    lines = [line.strip() for line in said.splitlines()]
    assert "scaled Jacobian: 0.500 to 1.000" in lines
    assert "0.9 to 1.0: 1 elements" in lines
    worst = lines.index("worst elements, numbered from 0 as in the file") + 1
    assert lines[worst] == "element 1: 0.500 at (1.36603, 0.5, 1.5)"
    assert lines[worst + 1].startswith("element 0: 1.000 at (0.5, 0.5, 0.5)")
