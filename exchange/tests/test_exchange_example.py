"""The worked example and the table of README.md: what comes out is what they say."""

import importlib.util
import re
import shutil
from pathlib import Path

import command_line
import pytest
from command_line import ROOT, documented, ran, sandglass

README = (ROOT / "exchange" / "README.md").read_text()
needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="ccx is not installed")
needs_gmsh = pytest.mark.skipif(shutil.which("gmsh") is None, reason="gmsh is not installed")


@pytest.fixture
def example(tmp_path):
    return Path(shutil.copytree(ROOT / "exchange" / "example", tmp_path / "example"))


def run(*words, folder):
    done = ran(*words, cwd=folder)
    assert done.returncode == 0, done.stdout + done.stderr


def record_of(*words, folder):
    """What `sandglass score` finds, as it is written."""
    return documented("score", *words, cwd=folder, code=0)[1]["records"][0]


def test_the_papers_element_is_near_the_mixed_one_but_not_the_same(example):
    assert sandglass("run", "hook.toml", "-o", "hook.h5", cwd=example).returncode == 0
    record = record_of("hook.h5", "--case", "hook.toml", folder=example)
    assert 1e-3 < record["twin"]["max_relative_error"] < 0.1  # on a mesh of three by three


@pytest.mark.skipif(importlib.util.find_spec("dolfinx") is None, reason="no FEniCSx")
def test_a_golden_of_ones_own(example):
    """The mixed element and its explicit counterpart agree on a mesh that came from elsewhere."""
    case = example / "hook.toml"
    assert sandglass("mesh", case, "-o", example / "mesh.h5").returncode == 0
    solve = ["/usr/bin/python3", ROOT / "reference/solve.py", "golden", case, "--mesh", "mesh.h5"]
    run(*solve, "-o", "golden.h5", folder=example)
    case.write_text(case.read_text() + '[comparison]\ngolden = "golden.h5"\n')
    command = ["run", case, "-m", "tl-mean-dilatation", "-o", example / "md.h5"]
    assert sandglass(*command).returncode == 0
    record = record_of("md.h5", "--case", case, folder=example)
    # Both leave a residual of 1e-8; the case's limit for the column is the same.
    assert record["golden"]["max_relative_error"] < 1e-6 and record["finding"] == "good"


@needs_gmsh
def test_the_example_is_what_its_geometry_gives(example):
    before = sandglass("mesh", example / "hook.toml", "-o", example / "a.h5").stdout
    run("gmsh", "-3", "hook.geo", "-o", "hook.msh", folder=example)
    assert sandglass("mesh", example / "hook.toml", "-o", example / "a.h5").stdout == before


def test_a_page_that_cannot_be_made_leaves_the_old_one(tmp_path, monkeypatch):
    (tmp_path / "build" / "page").mkdir(parents=True)
    (tmp_path / "ci").symlink_to(ROOT / "ci")
    monkeypatch.setenv("SANDGLASS_BINARY", str(Path(command_line.BINARY).resolve()))
    for words, message in (([], "no case"), (["none.toml"], "neither a file nor a known case")):
        command = ["bash", "ci/page", *words]
        done = ran(*command, cwd=tmp_path)
        assert done.returncode == 2 and message in done.stderr
    assert [path.name for path in (tmp_path / "build").iterdir()] == ["page"]


def table():
    """element -> figures in % (max, profile and rms to the golden, max to the truth)."""
    rows = re.findall(r"^\| (C3D8\w?) \| (.*) \|$", README, re.MULTILINE)
    return {element: [float(cell) for cell in cells.split(" | ")] for element, cells in rows}


@needs_ccx
@pytest.mark.parametrize("element", ["C3D8", "C3D8R", "C3D8I"])
def test_the_table_of_calculix(tmp_path, element):
    """To a unit of the third digit: other processors sum in other orders, .frd has six digits."""
    deck = ["mesh", "column", "--deck", "calculix", "--element", element]
    assert sandglass(*deck, "-o", tmp_path / "column.inp").returncode == 0
    run("ccx", "column", folder=tmp_path)
    record = record_of("column.frd", "--case", "column", folder=tmp_path)
    names = ("max_relative_error", "profile_relative_error", "rms_relative_error")
    found = [100 * record["golden"][name] for name in names]
    found.append(100 * record["truth"]["max_relative_error"])
    assert found == pytest.approx(table()[element], rel=0.01)
    if element == "C3D8":
        assert_is_the_displacement_element(tmp_path, record)


def assert_is_the_displacement_element(folder, record):
    """C3D8 is tl-full in another program: the same answer, to the six digits that are written."""
    sandglass("run", "column", "-m", "tl-full", "-o", folder / "full.h5", code=0)
    own = record_of("full.h5", "--case", "column", folder=folder)
    for reference in ("golden", "truth"):
        for name, figure in own[reference].items():
            # A digit lost of displacements up to 0.5 m, of 0.58 m imposed, in three components.
            assert abs(record[reference][name] - figure) < 5e-6 * 3**0.5
