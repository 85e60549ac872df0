"""Wrong input gives exit code 2 (3 if there is no equilibrium) and leaves no file behind."""

import h5py
import pytest

import solve
from blocks import CASE
from reference_file import read_reference


def _run(folder, kind="golden", mesh="mesh.h5", options=()):
    """Exit code of the command line on the files of the folder."""
    before = {path.name for path in folder.iterdir()}
    arguments = [kind, folder / "block.toml", "--mesh", folder / mesh, "-o", folder / "out.h5"]
    arguments += options
    code = solve.main([str(argument) for argument in arguments])
    new = {path.name for path in folder.iterdir()} - before
    assert new == ({"out.h5"} if code == 0 else set())
    return code


def test_good_input(folder):
    assert _run(folder) == 0
    points, displacement, attributes = read_reference(folder / "out.h5")
    top, bottom = points[:, 2] == 1, points[:, 2] == 0
    # Exact: prescribed values are copied, not computed.
    assert (displacement[top, 2] == 0.1).all() and (displacement[bottom] == 0).all()
    assert (displacement[top, :2] != 0).any()  # components = "z" leaves x and y free
    assert attributes["case_hash"] == "0123456789abcdef"
    assert attributes["mesh_hash"] == "fedcba9876543210"
    assert attributes["element"] == "Q1-P0"
    assert attributes["largest_imposed"] == 0.1


@pytest.mark.parametrize(
    "old, new, words",
    [
        (
            'law = "neo-hookean"',
            'law = "neo-hokean"',
            ["material.law", "neo-hokean", "did you mean"],
        ),
        ("poisson_ratio = 0.49", "poison_ratio = 0.4", ["poison_ratio", "'poisson_ratio'"]),
        ("value = [0.0, 0.0, 0.1]", "value = [0.0, 0.1]", ["displacement[1].value", "three"]),
        ("value = [0.0, 0.0, 0.1]", "value = [0.0, 0.0, nan]", ["displacement[1].value", "finite"]),
        ("value = [0.0, 0.0, 0.1]", "value = [0.0, 0.0, 0.0]", ["moves no node"]),
        ('components = "z"', 'components = "w"', ["displacement[1].components", "'w'"]),
        ('components = "z"', 'component = "z"', ["displacement[1].component", "'components'"]),
        ('set = "top"', 'set = "lid"', ["displacement.set", "'lid'", "bottom, top"]),
        ('set = "top"', 'set = "bottom"', ["bottom", "already prescribed"]),
        ("[[displacement]]", "[displacement]", ["displacement"]),
        ("[case]", "[case", ["not a TOML file"]),
        ('name = "block"', 'name = "brick"', ["'block'", "another case", "'brick'"]),
    ],
)
def test_wrong_case_file(folder, capsys, old, new, words):
    (folder / "block.toml").write_text(CASE.replace(old, new))
    assert _run(folder) == 2
    message = capsys.readouterr().err
    assert message.startswith("error: ")
    for word in words + [str(folder)]:
        assert word in message


def test_missing_files(folder, capsys):
    assert _run(folder, mesh="nothing.h5") == 2
    assert "nothing.h5" in capsys.readouterr().err
    (folder / "block.toml").unlink()
    assert _run(folder) == 2
    assert "block.toml" in capsys.readouterr().err


def test_output_that_cannot_be_written(folder, capsys):
    arguments = ["golden", folder / "block.toml", "--mesh", folder / "mesh.h5", "-o"]
    for output in (folder / "nowhere" / "out.h5", folder):
        assert solve.main([str(argument) for argument in arguments + [output]]) == 2
        assert f"{output}: cannot be written" in capsys.readouterr().err


def test_files_without_a_mesh(folder, capsys):
    content = (folder / "mesh.h5").read_bytes()
    (folder / "mesh.h5").write_bytes(content[: len(content) // 2])
    assert _run(folder) == 2
    assert "mesh.h5" in capsys.readouterr().err
    with h5py.File(folder / "mesh.h5", "w") as file:
        file["mesh/points"] = [[0.0, 0.0, 0.0]]
    assert _run(folder) == 2
    assert "mesh.h5: is not of `sandglass mesh`: " in capsys.readouterr().err


def test_no_equilibrium(folder, capsys):
    # Both ends are held and the upper one is pushed through the lower one: elements must invert.
    (folder / "block.toml").write_text(CASE.replace("[0.0, 0.0, 0.1]", "[0.0, 0.0, -1.2]"))
    assert _run(folder) == 3
    assert "no equilibrium" in capsys.readouterr().err
