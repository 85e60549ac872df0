"""The commands of README.md and of the top README are run as they stand there."""

import importlib.util
import json
import re
import shutil
import subprocess
from pathlib import Path

import command_line
import pytest
from command_line import ROOT, sandglass

README = (ROOT / "exchange" / "README.md").read_text()
TOP = (ROOT / "README.md").read_text()
needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="ccx is not installed")


def commands_of(text, title):
    """The commands below a title, as words; comments and line ends cut, `sandglass` first."""
    section = text[text.index(title) :]
    section = section[: section.index("\n## ", 5)].replace("\\\n", " ")
    lines = re.findall(r"^ {4}(?:build/release/)?(.*?)(?:\s+#.*)?$", section, re.MULTILINE)
    return [re.findall(r'"[^"]*"|\S+', line) for line in lines]


def run(words, folder):
    """Runs a command in a folder; what it printed."""
    words = [word.strip('"') for word in words]
    if words[0] == "sandglass":
        done = sandglass(*words[1:], cwd=folder)
    else:
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture
def example(tmp_path):
    shutil.copytree(ROOT / "exchange" / "example", tmp_path / "example")
    return tmp_path / "example"


def test_from_gmsh_to_the_answer(example):
    commands = commands_of(README, "## From Gmsh")
    commands = commands[:5]
    names = [" ".join(words[:2]) for words in commands]
    assert names == [
        "gmsh -3",
        "sandglass mesh",
        "sandglass run",
        "sandglass choose",
        "sandglass score",
    ]
    if shutil.which("gmsh") is None:
        commands = commands[1:]
    for words in commands:
        said = run(words, example)
    assert "against the golden's twin (computed)" in said
    (record,) = json.loads((example / "hook.json").read_text())["records"]
    # The paper's element on a mesh of three by three: near the mixed one, but not the same.
    assert 1e-3 < record["twin"]["max_relative_error"] < 0.1
    assert run("sandglass run chosen.toml".split(), example)


@pytest.mark.skipif(importlib.util.find_spec("dolfinx") is None, reason="no FEniCSx")
def test_a_golden_of_ones_own(example, tmp_path):
    """The mixed element and its explicit twin agree on a mesh that came from elsewhere."""
    (tmp_path / "exchange").mkdir()
    example = example.rename(tmp_path / "exchange" / "example")
    (tmp_path / "reference").symlink_to(ROOT / "reference")
    for words in commands_of(README, "## From Gmsh")[-2:]:
        run(words, tmp_path)
    case = example / "hook.toml"
    named = '[comparison]\ngolden = "../../hook-golden.h5"\n'
    case.write_text(case.read_text() + named)
    run(["sandglass", "run", str(case), "-m", "tl-mean-dilatation", "-o", "md.h5"], tmp_path)
    run(["sandglass", "score", "md.h5", "--case", str(case), "--json", "md.json"], tmp_path)
    (record,) = json.loads((tmp_path / "md.json").read_text())["records"]
    # Both leave a residual of 1e-8; the case's limit for the column is the same.
    assert record["golden"]["max_relative_error"] < 1e-6 and record["finding"] == "good"


def test_the_example_is_what_its_geometry_gives(example):
    if shutil.which("gmsh") is None:
        pytest.skip("gmsh is not installed")
    before = sandglass("mesh", example / "hook.toml", "-o", example / "a.h5").stdout
    run("gmsh -3 hook.geo -o hook.msh".split(), example)
    assert sandglass("mesh", example / "hook.toml", "-o", example / "a.h5").stdout == before


def test_own_mesh_of_the_top_readme(tmp_path, monkeypatch):
    """From the clone to the page, in a folder that looks like it; set-up and build are done."""
    binary = Path(command_line.BINARY).resolve()
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "release").symlink_to(binary.parent)
    for folder in ("cases", "ci", "exchange", "reference", "reports", "verification"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    monkeypatch.setenv("SANDGLASS_BINARY", str(binary))  # ci/page builds none
    commands = [" ".join(words) for words in commands_of(TOP, "## Your own mesh")]
    assert [command.split()[:2] for command in commands[:2]] == [
        ["bash", "ci/setup"],
        ["bash", "ci/build"],
    ]
    assert commands[-1] == "bash ci/page hook/hook.toml"
    for command in commands[2:]:
        if command.startswith("gmsh") and shutil.which("gmsh") is None:
            command = "cp exchange/example/hook.msh hook/"
        run(command.split(), tmp_path)
    page = (tmp_path / "build" / "page" / "index.html").read_text()
    points = [
        json.loads(found)
        for found in re.findall(
            r'\{"case":"hook","method":"tl-[^{}]*\{"max":[^{}]*\}[^{}]*\}', page
        )
    ]
    found = {(p["method"], p["precision"]) for p in points if p["golden"]["max"] < 0.01}
    # On the chart: near enough to the mixed element, with a cost; the paper's element is not.
    assert {("tl-four-point", "double"), ("tl-mean-dilatation", "float")} <= found
    assert all(point["simulated"] > 0 for point in points)
    assert ("tl-perturbation", "double") in {(p["method"], p["precision"]) for p in points}
    assert ("tl-perturbation", "double") not in found
    assert list((tmp_path / "build").glob("page.*")) == []  # nothing half-made beside it


def test_a_page_that_cannot_be_made_leaves_the_old_one(tmp_path, monkeypatch):
    (tmp_path / "build" / "page").mkdir(parents=True)
    (tmp_path / "ci").symlink_to(ROOT / "ci")
    monkeypatch.setenv("SANDGLASS_BINARY", str(Path(command_line.BINARY).resolve()))
    for words, told in (([], "no case"), (["none.toml"], "neither a file nor a known case")):
        command = ["bash", "ci/page", *words]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 2 and told in done.stderr
    assert [path.name for path in (tmp_path / "build").iterdir()] == ["page"]


@needs_ccx
@pytest.mark.parametrize(
    "text, title",
    [(TOP, "## Your own result"), (README, "## Scoring another")],
    ids=["top", "exchange"],
)
def test_scoring_calculix(tmp_path, text, title):
    commands = commands_of(text, title)
    assert [words[0] for words in commands[:3]] == ["sandglass", "ccx", "sandglass"]
    for words in commands[:3]:
        said = run(words, tmp_path)
    assert "against the golden" in said and "against the truth" in said
    for words in commands[3:4]:  # what ci/verify leaves, for this case, and the score beside it
        verify = "sandglass verify column --json build/verdicts.json --results build/verify"
        (tmp_path / "build").mkdir()
        run(verify.split(), tmp_path)
        run(words, tmp_path)
        records = json.loads((tmp_path / "build/verdicts.json").read_text())["records"]
        assert "ccx C3D8R" in [record["method"] for record in records]


def table():
    """element -> figures in % (max, profile and rms to the golden, max to the truth)."""
    rows = re.findall(r"^\| (C3D8\w?) \| (.*) \|$", README, re.MULTILINE)
    return {element: [float(cell) for cell in cells.split(" | ")] for element, cells in rows}


@needs_ccx
@pytest.mark.parametrize("element", ["C3D8", "C3D8R", "C3D8I"])
def test_the_table_of_calculix(tmp_path, element):
    """To a unit of the third digit: other processors sum in other orders, .frd has six digits."""
    deck = ["mesh", "column", "--format", "inp", "--deck", "--element", element]
    assert sandglass(*deck, "-o", tmp_path / "column.inp").returncode == 0
    run(["ccx", "column"], tmp_path)
    words = ["score", "column.frd", "--case", "column", "--json", "score.json"]
    assert sandglass(*words, cwd=tmp_path).returncode == 0
    (record,) = json.loads((tmp_path / "score.json").read_text())["records"]
    names = ("max_relative_error", "profile_relative_error", "rms_relative_error")
    found = [100 * record["golden"][name] for name in names]
    found.append(100 * record["truth"]["max_relative_error"])
    assert found == pytest.approx(table()[element], rel=0.01)
    if element == "C3D8":
        assert_is_the_displacement_element(tmp_path, record)


def assert_is_the_displacement_element(folder, record):
    """C3D8 is tl-full in another program: the same answer, to the six digits that are written."""
    done = sandglass("run", "column", "-m", "tl-full", "-o", folder / "full.h5")
    assert done.returncode == 0
    words = ["score", "full.h5", "--case", "column", "--json", "full.json"]
    assert sandglass(*words, cwd=folder).returncode == 0
    (own,) = json.loads((folder / "full.json").read_text())["records"]
    for reference in ("golden", "truth"):
        for name, figure in own[reference].items():
            # A digit lost of displacements up to 0.5 m, of 0.58 m imposed, in three components.
            assert abs(record[reference][name] - figure) < 5e-6 * 3**0.5
