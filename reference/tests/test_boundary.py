"""Which degrees of freedom of Q2 are prescribed: the trace of the Q1 displacement."""

import numpy as np

from blocks import MATERIALS, distorted_block
from hexahedra import Condition, HexMesh
from problem import GOLDEN, TRUTH, MixedProblem


def _prescribed(pair, nodes_of, components=(0, 1, 2)):
    """The prescribed dofs of a regular 2 x 2 x 2 block: (points, components, values)."""
    points, cells, _ = distorted_block(n=2, distortion=0.0)
    condition = Condition(nodes_of(points), components, 1.0 + points)
    problem = MixedProblem(HexMesh(points, cells, (condition,)), pair, MATERIALS)
    at = problem.displacement.function_space.tabulate_dof_coordinates()
    return at[problem.fixed // 3], problem.fixed % 3, problem.values


def test_a_whole_face():
    for pair, count in ((GOLDEN, 3 * 3), (TRUTH, 5 * 5)):
        at, component, values = _prescribed(pair, lambda x: x[:, 2] == 0)
        assert len(at) == 3 * count
        assert np.abs(at[:, 2]).max() < 1e-15  # mapped by dolfinx: round-off of numbers <= 1
        # The imposed field 1 + x is linear, so its Q1 trace is itself, to round-off.
        assert np.abs(values - 1 - at[np.arange(len(at)), component]).max() < 1e-15


def test_three_corners_of_a_face_hold_their_edges_but_not_the_face():
    def corner(x):
        return (x[:, 2] == 0) & (x[:, 0] + x[:, 1] <= 0.5)

    at, _, _ = _prescribed(TRUTH, corner)
    # Vertices (0,0), (1/2,0), (0,1/2) and the mid-points of the two edges between them.
    expected = {(0, 0), (0.5, 0), (0, 0.5), (0.25, 0), (0, 0.25)}
    assert {tuple(np.round(p[:2], 12)) for p in at} == expected
    assert len(at) == 3 * len(expected)


def test_one_component_only():
    _, component, _ = _prescribed(TRUTH, lambda x: x[:, 0] == 0, components=(1,))
    assert len(component) == 5 * 5
    assert (component == 1).all()
