"""Half a symmetric mesh gives the whole answer; a mesh without symmetry is left unchanged."""

import numpy as np
import pytest

from blocks import MATERIALS, distorted_block, pressed_block
from hexahedra import HexMesh
from newton import solve
from problem import MixedProblem
from symmetry import halve

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
