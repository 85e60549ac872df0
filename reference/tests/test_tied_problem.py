"""Hanging nodes: a linear field is an answer, in FEniCSx and in SfePy, and forces are conserved."""

import dataclasses
import itertools

import numpy as np
import pytest

from blocks import MATERIALS, affine, distorted_block
from case_file import Material
from hexahedra import Condition, HexMesh, Touching, refine
from newton import solve
from obstacles import Obstacle
from problem import MixedProblem
from tied_problem import TiedProblem

GRADIENT = [[0.02, 0.05, -0.03], [0.04, -0.03, 0.02], [-0.05, 0.01, 0.02]]


@pytest.fixture
def block():
    """A distorted cube of eight cells, the first split in eight: (HexMesh, values, inside).

    Its nodes in the middle of edges and faces of other cells hang. A linear field is imposed except
    at inside, (n,) bool: hanging nodes, and the node in the middle of the cube.
    """
    points, cells, boundary = distorted_block(n=2)
    split = refine(HexMesh(points, cells[:1], ()))
    points = split.points
    pairs = set()
    for number, cell, k in itertools.product(range(len(boundary), len(points)), cells[1:], (2, 4)):
        for among in itertools.combinations(cell, k):
            if np.allclose(points[number], points[list(among)].mean(axis=0), atol=1e-12):
                pairs |= {(number, corner, 1 / k) for corner in among}
    ties = tuple(map(np.array, zip(*sorted(pairs))))
    assert len(np.unique(ties[0])) == 3 + 9  # three faces with nine edges are shared with others
    inside = np.zeros(len(points), dtype=bool)
    inside[: len(boundary)] = ~boundary
    inside[ties[0]] = True
    values = affine(points, GRADIENT)
    held = (Condition(~inside, (0, 1, 2), values),)
    mesh = HexMesh(points, np.concatenate([split.cells, cells[1:]]), held, ties=ties)
    return mesh, values, inside


@pytest.mark.parametrize("program", ["FEniCSx", "SfePy"])
def test_patch(block, program):
    make = MixedProblem
    if program == "SfePy":
        make = pytest.importorskip("sfepy_problem").SfepyProblem
    mesh, values, _ = block
    problem = TiedProblem(make(mesh, MATERIALS), mesh.ties)
    outcome = solve(problem, 1, 1e-10)
    assert outcome.residual < 1e-9
    np.testing.assert_allclose(problem.nodal_displacement(), values, atol=1e-12)


def test_without_ties_it_is_no_answer(block):
    """The test above can fail: cracks open at nodes that do not follow."""
    mesh, values, _ = block
    problem = MixedProblem(mesh, MATERIALS)
    solve(problem, 1, 1e-10)
    assert np.abs(problem.nodal_displacement() - values).max() > 1e-4


def test_forces_are_transferred(block):
    mesh, values, inside = block
    problem = TiedProblem(MixedProblem(mesh, MATERIALS), mesh.ties)
    moved = np.random.default_rng(1).normal(scale=0.01, size=values.size)
    problem.displacement.array[:] = moved
    forces, _ = problem.mixed_residual()
    of_nodes = forces[problem.node_dofs()]
    assert (of_nodes[mesh.ties[0]] == 0).all() and (of_nodes[~inside] != 0).all()
    # Internal forces conserve momentum.
    np.testing.assert_allclose(of_nodes.sum(axis=0), 0.0, atol=1e-10 * np.abs(forces).max())


def test_an_obstacle_presses_hanging_nodes(block):
    """On the side where the mesh is fine: the stress is uniform, (1 - s^2)/2 s, s the stretch."""
    mesh, _, _ = block
    side = round(mesh.points[mesh.cells[0]].mean(axis=0)[2])
    sign = 2 * side - 1
    plate = {"point": (0, 0, side), "normal": (0, 0, -sign)}
    obstacle = Obstacle("side", "plane", plate, (0, 0, -0.2 * sign))
    ends = {0: (0.0, 0), 1: (0.0, 1), 2: (1.0 - side, 2)}
    held = tuple(
        Condition(mesh.points[:, axis] == end, (axis,), np.zeros_like(mesh.points))
        for end, axis in ends.values()
    )
    touching = (Touching(mesh.points[:, 2] == side, obstacle),)
    mesh = dataclasses.replace(mesh, conditions=held, touching=touching)
    material = Material("st-venant-kirchhoff", {"young_modulus": 1.0, "poisson_ratio": 0.0})
    problem = MixedProblem(mesh, [material])
    tied = TiedProblem(problem, mesh.ties)
    solve(tied, 2, 1e-10)
    height = sign * (mesh.points[:, 2] - (1 - side))
    assert np.abs(tied.nodal_displacement()[:, 2] + 0.2 * sign * height).max() < 1e-9
    (contact,) = problem.loads.contacts
    _, pressure, _ = contact.state(problem.displacement.x.array, 1.0)
    assert abs(contact.areas @ pressure - (1 - 0.8**2) / 2 * 0.8) < 1e-8
