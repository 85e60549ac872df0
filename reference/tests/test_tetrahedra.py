"""Quadratic tetrahedra cut from hexahedra: they conform, fill the body and converge."""

import dataclasses

import basix
import numpy as np
import pytest
import ufl
from dolfinx import fem

from blocks import MATERIALS, affine, affine_patch, distorted_block, with_hanging_nodes
from common.hexahedron import gauss_jacobians
from hexahedra import Condition, HexMesh, traction
from newton import solve
from taylor_hood import TaylorHoodProblem, _slopes
from tetrahedra import cut

GRADIENT = [[0.2, 0.1, -0.1], [0.05, -0.1, 0.15], [-0.1, 0.1, 0.05]]
# One cell, two that share at most an edge or a vertex, most cells: all kinds of hanging faces.
SPLITS = [[], [0], [3, 17], [13, 4, 22, 9, 1], list(range(2, 27))]


def faces_of(cells):
    """Nodes (k, 6) of all faces of quadratic tetrahedra: vertices, then edges."""
    edges = [(2, 3), (1, 3), (1, 2), (0, 3), (0, 2), (0, 1)]
    rows = []
    for face in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)):
        on = [4 + number for number, edge in enumerate(edges) if set(edge) <= set(face)]
        rows.append(cells[:, [*face, *on]])
    return np.concatenate(rows)


@pytest.mark.parametrize("split", SPLITS)
def test_tetrahedra_conform(split):
    mesh = with_hanging_nodes(affine_patch(GRADIENT, distortion=0.3), split)
    tetrahedra = cut(mesh)
    faces = faces_of(tetrahedra.cells)
    _, first, count = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    assert set(count) == {1, 2}
    # A face of one tetrahedron alone lies in a side of the unit cube, whose nodes do not move.
    outer = tetrahedra.points[faces[first[count == 1]]]
    on_side = (np.abs(outer) < 1e-14) | (np.abs(outer - 1) < 1e-14)
    assert on_side.all(axis=1).any(axis=1).all()


@pytest.mark.parametrize("split", SPLITS)
def test_tetrahedra_fill_the_hexahedra(split):
    mesh = with_hanging_nodes(affine_patch(GRADIENT, distortion=0.3), split)
    tetrahedra = cut(mesh)
    # The determinant of a quadratic map is cubic.
    places, weights = basix.make_quadrature(basix.CellType.tetrahedron, 3)
    slopes = _slopes(np.column_stack([1 - places.sum(axis=1), places]))
    jacobians = np.einsum("qaj,kai->qkij", slopes, tetrahedra.points[tetrahedra.cells])
    jacobians = np.linalg.det(jacobians)
    assert jacobians.min() > 0
    # Round-off of sums of a few thousand numbers. A wrong edge on a curved face costs 1e-4.
    found, expected = (jacobians.T @ weights).sum(), gauss_jacobians(mesh.points, mesh.cells).sum()
    assert abs(found - expected) < 1e-12
    assert abs(expected - 1) < 1e-12


def test_an_affine_field_is_reproduced():
    mesh = cut(with_hanging_nodes(affine_patch(GRADIENT), [13, 4]))
    problem = TaylorHoodProblem(mesh, MATERIALS)
    outcome = solve(problem, 2, 1e-10)
    # As in test_patch; curved elements contain affine fields as well.
    assert np.abs(problem.nodal_displacement() - affine(mesh.points, GRADIENT)).max() < 1e-11
    assert outcome.residual < 1e-11


def test_order_on_a_smooth_answer():
    """Strains of 1e-6, where the gradient of a harmonic function is an equilibrium."""
    size, errors = 1e-6, []
    for n in (2, 4):
        mesh = HexMesh(*distorted_block(n=n, distortion=0.0)[:2], ())
        mesh = cut(with_hanging_nodes(mesh, [] if n == 2 else [0]))
        x, y, z = mesh.points.T
        outer = ((mesh.points == 0) | (mesh.points == 1)).any(axis=1)
        exact = size * np.stack([np.exp(x) * np.cos(y), -np.exp(x) * np.sin(y), 0 * z], axis=1)
        held = (Condition(outer, (0, 1, 2), exact),)
        problem = TaylorHoodProblem(dataclasses.replace(mesh, conditions=held), MATERIALS)
        solve(problem, 1, 1e-10)
        X = ufl.SpatialCoordinate(problem.function.function_space.mesh)
        field = size * ufl.as_vector(
            (ufl.exp(X[0]) * ufl.cos(X[1]), -ufl.exp(X[0]) * ufl.sin(X[1]), 0 * X[2])
        )
        gap = problem.function - field
        measure = ufl.dx(metadata={"quadrature_degree": 6})
        errors.append(fem.assemble_scalar(fem.form(ufl.inner(gap, gap) * measure)) ** 0.5 / size)
    assert errors[1] < 1e-3
    assert np.log2(errors[0] / errors[1]) > 2.8  # third order, on meshes that are not yet fine


def test_nodes_at_the_edge_of_a_split_face_are_held_by_both_sides():
    points, cells, _ = distorted_block(n=2, distortion=0.0)
    condition = Condition(points[:, 2] == 0, (0, 1, 2), points)
    bottom = int(np.flatnonzero((points[cells][:, :, 2] == 0).any(axis=1))[0])
    mesh = cut(with_hanging_nodes(HexMesh(points, cells, (condition,)), [bottom]))
    (found,) = mesh.conditions
    assert (found.nodes == (mesh.points[:, 2] == 0)).all()


def test_a_traction_has_its_sum_and_moment():
    points, cells, _ = distorted_block(n=2)
    points[:, 0] = 2 + points[:, 0] * (1 - 0.4 * points[:, 1])  # a trapezoidal face
    total, moment = np.array([0.3, -0.2, 0.5]), np.array([0.1, 0.4, -0.7])
    load = traction(points, cells, points[:, 2] == 1, total, moment)
    mesh = cut(HexMesh(points, cells, (), (load,)))
    problem = TaylorHoodProblem(mesh, MATERIALS)
    forces = problem.nodal_forces()
    arms = mesh.points - load.centre
    # As in test_tractions: the undeformed body has no other forces.
    assert np.abs(forces.sum(axis=0) + total).max() < 1e-13
    assert np.abs(np.cross(arms, forces).sum(axis=0) + moment).max() < 1e-13


def test_an_answer_is_interpolated_to_another_mesh():
    block = affine_patch(GRADIENT, bulge=0.3)
    coarse = TaylorHoodProblem(cut(with_hanging_nodes(block, [0])), MATERIALS)
    solve(coarse, 1, 1e-10)
    same = TaylorHoodProblem(cut(with_hanging_nodes(block, [0])), MATERIALS)
    same.start_from(coarse)
    # Nodes are found in their tetrahedra to round-off.
    assert np.abs(same.displacement.array - coarse.displacement.array).max() < 1e-10
    fine = TaylorHoodProblem(cut(with_hanging_nodes(block, [5, 13])), MATERIALS)
    fine.start_from(coarse)
    outcome = solve(fine, 1, 1e-10, guessed=True)
    assert outcome.load_steps == 1 and outcome.newton_iterations < 5
