"""Which degrees of freedom are prescribed: the trace of the Q1 displacement, for both elements."""

import numpy as np
import pytest

from blocks import MATERIALS, distorted_block
from hexahedra import Condition, HexMesh
from problem import MixedProblem
from tetrahedra import cut


def _block(nodes_of, components=(0, 1, 2)):
    """A regular 2 x 2 x 2 block of which some nodes have the displacement 1 + x."""
    points, cells, _ = distorted_block(n=2, distortion=0.0)
    return HexMesh(points, cells, (Condition(nodes_of(points), components, 1.0 + points),))


def test_a_whole_face():
    problem = MixedProblem(_block(lambda x: x[:, 2] == 0), MATERIALS)
    at = problem.displacement.function_space.tabulate_dof_coordinates()[problem.fixed // 3]
    assert len(at) == 3 * 3 * 3
    assert np.abs(at[:, 2]).max() < 1e-15  # mapped by dolfinx: round-off of numbers <= 1
    assert (
        np.abs(problem.values_at(1.0) - 1 - at[np.arange(len(at)), problem.fixed % 3]).max() < 1e-15
    )


def test_one_component_only():
    problem = MixedProblem(_block(lambda x: x[:, 0] == 0, components=(1,)), MATERIALS)
    at = problem.displacement.function_space.tabulate_dof_coordinates()[problem.fixed // 3]
    assert len(at) == 3 * 3 and np.abs(at[:, 0]).max() < 1e-15
    assert (problem.fixed % 3 == 1).all()


@pytest.mark.parametrize(
    ("nodes_of", "expected"),
    [
        (lambda x: x[:, 2] == 0, 25),  # a lattice of twice the elements
        # Three corners of a face hold two of its edges, not its diagonal.
        (lambda x: (x[:, 2] == 0) & (x[:, 0] + x[:, 1] <= 0.5), 5),
    ],
)
def test_nodes_of_tetrahedra(nodes_of, expected):
    mesh = cut(_block(nodes_of))
    (found,) = mesh.conditions
    assert found.nodes.sum() == expected
    assert np.abs(mesh.points[found.nodes, 2]).max() == 0
    assert np.abs(found.values - 1 - mesh.points).max() < 1e-15  # it is linear
