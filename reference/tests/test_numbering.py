"""Vertex order and node numbers survive the conversion to dolfinx and back."""

import numpy as np

from blocks import MATERIALS, affine, affine_patch
from common.hexahedron import LEXICOGRAPHIC
from hexahedra import Condition, HexMesh
from newton import solve
from problem import MixedProblem

GRADIENT = [[0.1, 0.2, -0.1], [0.05, -0.1, 0.3], [-0.2, 0.1, 0.05]]


def test_vertex_order_is_its_own_inverse():
    # Exact: integers.
    assert (LEXICOGRAPHIC[LEXICOGRAPHIC] == np.arange(8)).all()
    # The unit cube's VTK vertices, reordered, count in binary with x fastest.
    x = np.array([0, 1, 1, 0, 0, 1, 1, 0])
    y = np.array([0, 0, 1, 1, 0, 0, 1, 1])
    z = np.array([0, 0, 0, 0, 1, 1, 1, 1])
    assert ((x + 2 * y + 4 * z)[LEXICOGRAPHIC] == np.arange(8)).all()


def test_affine_displacement_comes_back_in_the_callers_numbering():
    mesh = affine_patch(GRADIENT)
    problem = MixedProblem(mesh, MATERIALS)
    # dolfinx interpolates the vertices' coordinates: products and sums of numbers <= 1, so a few
    # units of the last place, 2.2e-16.
    assert np.abs(problem.nodal_points() - mesh.points).max() < 1e-14
    problem.displacement.interpolate(lambda x: np.asarray(GRADIENT) @ x)
    difference = problem.nodal_displacement() - affine(mesh.points, GRADIENT)
    assert np.abs(difference).max() < 1e-14


def test_a_shuffled_mesh_gives_shuffled_displacements():
    # The pitfall itself: the same block under another numbering, solved for a non-affine answer.
    mesh = affine_patch(GRADIENT, bulge=0.1)
    order = np.random.default_rng(7).permutation(len(mesh.points))  # old number of each new node
    (old,) = mesh.conditions
    condition = Condition(old.nodes[order], old.components, old.values[order])
    other = HexMesh(mesh.points[order], np.argsort(order)[mesh.cells], (condition,))
    answers = []
    for m in (mesh, other):
        problem = MixedProblem(m, MATERIALS)
        solve(problem, 2, 1e-10)
        answers.append(problem.nodal_displacement())
    # Both are exact to round-off times the conditioning of an 8-node interior, far below 1e-12;
    # a node read in a wrong place would differ by about 0.1.
    assert np.abs(answers[0][order] - answers[1]).max() < 1e-12
