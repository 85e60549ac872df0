"""Half a symmetric mesh gives the whole answer; a mesh without symmetry is left unchanged."""

import dataclasses

import numpy as np
import pytest

from blocks import MATERIALS, distorted_block, pressed_block
from case_file import Gravity
from common.errors import InputError
from hexahedra import Condition, HexMesh
from newton import solve
from problem import MixedProblem
from symmetry import halve, part_bodies

TOLERANCE = 1e-10


def _answer(mesh):
    problem = MixedProblem(mesh, MATERIALS)
    solve(problem, 2, TOLERANCE)
    return problem.nodal_displacement()


@pytest.mark.parametrize("value, axes", [((0, 0, -0.2), [0, 1]), ((0.1, 0, -0.2), [1])])
def test_part_gives_the_whole_answer(value, axes):
    mesh = pressed_block(value)
    part, halves = halve(mesh)
    assert [half.axis for half in halves] == axes
    assert len(part.cells) == len(mesh.cells) // 2 ** len(axes)
    displacement = _answer(part)
    for half in reversed(halves):
        displacement = half.expand(displacement)
    # The solution is unique and symmetric; both are converged to round-off, see test_patch.
    assert np.abs(displacement - _answer(mesh)).max() < 1e-11


@pytest.mark.parametrize("change", ["value", "nodes", "geometry", "cut cells"])
def test_no_symmetry(change):
    mesh = pressed_block()
    if change == "value":
        mesh = pressed_block((0.1, 0.1, -0.2))
    if change == "nodes":
        off_both_planes = np.abs(mesh.points - [0.25, 0.25, 1.0]).max(axis=1) < 1e-12
        mesh.conditions[1].nodes[off_both_planes] = False
    if change == "geometry":
        mesh = pressed_block(distortion=0.1)
    if change == "cut cells":
        mesh = HexMesh(*distorted_block(n=3, distortion=0.0)[:2], ())
    part, halves = halve(mesh)
    assert not halves and part is mesh


def stacked_blocks(gap=0.1, into=0.05):
    """Two unit blocks one above the other, pressed until each is `into` shorter."""
    points, cells, _ = distorted_block(n=2, distortion=0.0)
    mirrored = points * [1, 1, -1] - [0, 0, gap]
    both = np.concatenate([points, mirrored])
    # Reflection turns elements inside out: their lower and upper faces change places.
    below = len(points) + cells[:, [4, 5, 6, 7, 0, 1, 2, 3]]
    height = both[:, 2] + gap / 2
    end, face = np.abs(height) > 1 + gap / 2 - 1e-9, np.abs(height) < gap / 2 + 1e-9
    pressed = np.outer(-np.sign(height) * (gap / 2 + into), [0, 0, 1])
    return HexMesh(
        both,
        np.concatenate([cells, below]),
        (
            Condition(end, (2,), pressed),
            Condition(np.full(len(both), True), (0, 1), np.zeros_like(both)),
        ),
        contacts=((face & (height > 0), face & (height < 0)),),
    )


def test_two_bodies_are_one_on_a_plane():
    """Between walls, the strain is uniform: displacements are linear over the height."""
    gap, into = 0.1, 0.05
    mesh = stacked_blocks(gap, into)
    part, halves = part_bodies(mesh)
    assert len(part.cells) == len(mesh.cells) // 2 and not part.contacts
    problem = MixedProblem(part, MATERIALS)
    solve(problem, 2, TOLERANCE)
    displacement = halves[0].expand(problem.nodal_displacement())
    height = mesh.points[:, 2] + gap / 2
    exact = -np.sign(height) * (gap / 2 + into * (np.abs(height) - gap / 2))
    assert np.abs(displacement[:, 2] - exact).max() < 1e-9
    assert halve(mesh)[1][0].axis == 2


@pytest.mark.parametrize("change", ["points", "values", "joined", "weight"])
def test_other_pairs_of_bodies_are_refused(change):
    mesh = stacked_blocks()
    if change == "points":
        mesh.points[0] += 0.01
    if change == "values":
        mesh.conditions[0].values[mesh.points[:, 2] > 0] *= 1.1
    if change == "joined":
        mesh.cells[0, 0] = mesh.cells[-1, 0]
    if change == "weight":
        mesh = dataclasses.replace(mesh, gravity=(Gravity((0.0, 0.0, -1.0)),))
    with pytest.raises(InputError, match="mirror images of each other"):
        part_bodies(mesh)
