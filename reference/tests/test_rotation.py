"""Rotating node sets: positions of their nodes at every load and on split meshes."""

import numpy as np
import pytest

import solve
from common.accuracy import relative_errors
from blocks import CASE, ELEMENTS, MATERIALS, affine, distorted_block
from case_file import read_case
from common.errors import InputError
from hexahedra import Condition, HexMesh, refine, turn_about
from newton import solve as newton_solve
from reference_file import read_reference
from symmetry import halve

AXIS = np.array([2.0, -1.0, 2.0]) / 3
CENTER = np.array([0.3, 0.1, -0.2])
TURNED = """
[[rotation]]
set = "top"
axis = "z"
angle = 360.0
"""


def _rotation(axis, angle):
    """Rodrigues: the rotation matrix."""
    x, y, z = axis
    spin = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * spin + (1 - np.cos(angle)) * spin @ spin


def _turned_block(angle, **block):
    """A block whose whole boundary turns."""
    points, cells, boundary = distorted_block(**block)
    turn = turn_about(points, AXIS, CENTER, angle)
    return HexMesh(points, cells, (Condition(boundary, (0, 1, 2), np.zeros_like(points), turn),))


@pytest.mark.parametrize("load", [0.1, 0.5, 1.0])
def test_nodes_stay_on_their_circles(load):
    mesh = refine(_turned_block(7.0, n=2))
    prescribed, values = mesh.imposed(load)
    there = (mesh.points - CENTER) @ _rotation(AXIS, load * 7.0).T + CENTER
    # Rotations are linear in the points, so the means of a split mesh turn exactly.
    assert np.abs(values - (there - mesh.points))[prescribed].max() < 1e-14


@ELEMENTS
def test_a_turned_body_is_in_equilibrium(make):
    mesh = _turned_block(4.0)
    problem = make(mesh, MATERIALS)
    newton_solve(problem, 20, 1e-10)
    exact = affine(mesh.points - CENTER, _rotation(AXIS, 4.0)) + CENTER - mesh.points
    assert np.abs(problem.nodal_displacement()[: len(exact)] - exact).max() < 1e-11
    forces, _ = problem.mixed_residual()
    assert np.abs(forces).max() < 1e-8  # N, of a modulus of 3000 Pa on 1 m^2


def test_largest_imposed_is_the_largest_on_the_path():
    points, cells, _ = distorted_block(n=1)
    for angle in (0.5, np.pi, 2 * np.pi, -2 * np.pi):
        turn = turn_about(points, np.array([0.0, 0.0, 1.0]), points.mean(axis=0), angle)
        beside = np.tile([0.0, 0.0, 0.2], (len(points), 1))
        mesh = HexMesh(points, cells, (Condition(points[:, 2] == 1, (0, 1, 2), beside, turn),))
        chord = np.sqrt(2) * np.sin(min(abs(angle), np.pi) / 2)
        assert abs(mesh.largest_imposed() - 0.2 - chord) < 1e-15
        # A rotating set has no mirror plane, though its final values may be zero.
        assert halve(mesh)[1] == []


def _solve(folder, text):
    (folder / "block.toml").write_text(text)
    arguments = ["golden", folder / "block.toml", "--mesh", folder / "mesh.h5"]
    return solve.main([str(a) for a in arguments + ["-o", folder / "out.h5"]])


def test_a_full_turn_is_not_the_undeformed_state(folder):
    text = CASE[: CASE.rindex("[[displacement]]")] + TURNED
    assert _solve(folder, text) == 0
    points, displacement, attributes = read_reference(folder / "out.h5")
    assert attributes["largest_imposed"] == pytest.approx(np.sqrt(2))
    held = (points[:, 2] == 0) | (points[:, 2] == 1)
    assert np.abs(displacement[held]).max() < 1e-14
    assert relative_errors(displacement, np.zeros_like(displacement), 1.0)[0] > 0.1


def test_equal_rotations_of_a_node_are_allowed_and_others_refused(folder, capsys):
    start = CASE[: CASE.rindex("[[displacement]]")]
    assert _solve(folder, start + TURNED + TURNED.replace("360.0", "360")) == 0
    assert _solve(folder, start + TURNED + TURNED.replace("360.0", "720.0")) == 2
    assert "rotation.set = 'top'" in capsys.readouterr().err


@pytest.mark.parametrize(
    "old, new, words",
    [
        ('axis = "z"', 'axis = "w"', ["rotation[0].axis", "'w'"]),
        ('axis = "z"', "axis = [0, 0, 0]", ["rotation[0].axis", "zero"]),
        ('axis = "z"', "axis = [0, 1]", ["rotation[0].axis", "three"]),
        ("angle = 360.0", "angle = inf", ["rotation[0].angle", "finite"]),
        ("angle = 360.0", "angel = 360.0", ["rotation[0].angel", "'angle'"]),
        ("angle = 360.0", "angle = 1\ncenter = [0]", ["rotation[0].center", "three"]),
        ('set = "top"', "set = 3", ["rotation[0].set"]),
    ],
)
def test_wrong_rotations(tmp_path, old, new, words):
    (tmp_path / "block.toml").write_text(CASE + TURNED.replace(old, new))
    with pytest.raises(InputError) as error:
        read_case(tmp_path / "block.toml")
    for word in words:
        assert word in str(error.value)
