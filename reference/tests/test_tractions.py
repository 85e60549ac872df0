"""Tractions: their sum and moment, an exact answer, symmetry and refinement; variants of cases."""

from pathlib import Path

import numpy as np
import pytest

from blocks import ELEMENTS, MATERIAL, MATERIALS, affine, distorted_block, pressed_block
from case_file import find_case, read_case, read_tables
from common.errors import InputError
from hexahedra import Condition, HexMesh, refine, traction
from newton import solve
from problem import MixedProblem
from symmetry import halve

TOLERANCE = 1e-10


def _pulled(mesh, total, moment=(0.0, 0.0, 0.0), nodes_of=lambda x: x[:, 2] == 1):
    """A mesh with the conditions of another and one traction."""
    load = traction(mesh.points, mesh.cells, nodes_of(mesh.points), total, moment)
    return HexMesh(mesh.points, mesh.cells, mesh.conditions, (load,))


def test_sum_and_moment():
    points, cells, _ = distorted_block(n=2)
    # A trapezoidal face (its upper edge is shorter) away from the origin.
    points[:, 0] = 2 + points[:, 0] * (1 - 0.4 * points[:, 1])
    total, moment = np.array([0.3, -0.2, 0.5]), np.array([0.1, 0.4, -0.7])
    held = Condition(points[:, 2] == 0, (0, 1, 2), np.zeros_like(points))
    mesh = _pulled(HexMesh(points, cells, (held,)), total, moment)
    problem = MixedProblem(mesh, MATERIALS)
    problem.load = 0.5
    forces = problem.mixed_residual()[0].reshape(-1, 3)  # undeformed: minus the loads only
    at = problem.displacement.function_space.tabulate_dof_coordinates()
    arms = at - mesh.tractions[0].centre
    # Sums of about a hundred numbers of order 1.
    assert np.abs(forces.sum(axis=0) + 0.5 * total).max() < 1e-13
    assert np.abs(np.cross(arms, forces).sum(axis=0) + 0.5 * moment).max() < 1e-13


@ELEMENTS
def test_uniaxial_stress_under_a_dead_load(make):
    points, cells, _ = distorted_block()
    held = np.zeros_like(points)
    conditions = [Condition(points[:, axis] == 0, (axis,), held) for axis in range(3)]
    stress = 0.3 * MATERIAL["young_modulus"]
    mesh = _pulled(HexMesh(points, cells, tuple(conditions)), (0.0, 0.0, stress))  # of 1 m^2
    problem = make(mesh, MATERIALS)
    solve(problem, 3, TOLERANCE)
    u = problem.nodal_displacement()[: len(points)]
    tip = u[np.abs(points - 1).max(axis=1) == 0][0]
    assert np.abs(u - affine(points, np.diag(tip))).max() < 1e-10
    # First Piola stress of the law: sigma = mu J^(-5/3) (a^2 - I1/3) + K (J - 1); P = J sigma / a.
    E, nu = MATERIAL["young_modulus"], MATERIAL["poisson_ratio"]
    mu, K = E / 2 / (1 + nu), E / 3 / (1 - 2 * nu)
    a = 1 + tip
    J = a.prod()
    piola = (mu * J ** (-2 / 3) * (a**2 - (a**2).sum() / 3) + K * (J - 1) * J) / a
    # Round-off of displacements, 1e-11, times K / mu = 50.
    assert np.abs(piola / stress - [0, 0, 1]).max() < 1e-8


def test_refined_and_halved_loads_are_the_same():
    mesh = _pulled(pressed_block(), (0.0, 0.0, 100.0), nodes_of=lambda x: x[:, 2] == 1)
    mesh = HexMesh(mesh.points, mesh.cells, mesh.conditions[:1], mesh.tractions)
    fine = MixedProblem(refine(mesh), MATERIALS)
    fine.load = 1.0
    assert abs(fine.mixed_residual()[0].reshape(-1, 3)[:, 2].sum() + 100.0) < 1e-11
    part, halves = halve(mesh)
    assert [half.axis for half in halves] == [0, 1]
    answers = []
    for m in (mesh, part):
        problem = MixedProblem(m, MATERIALS)
        solve(problem, 2, TOLERANCE)
        answers.append(problem.nodal_displacement())
    for half in reversed(halves):
        answers[1] = half.expand(answers[1])
    assert np.abs(answers[0] - answers[1]).max() < 1e-11  # as in test_symmetry


@pytest.mark.parametrize(
    "total, moment, axes",
    [
        ((1.0, 0.0, 2.0), (0.0, 0.0, 0.0), [1]),
        ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), [0]),  # bends about x: mirrored by x, not by y
        ((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), []),
    ],
)
def test_load_without_the_symmetry_is_not_halved(total, moment, axes):
    mesh = _pulled(pressed_block(), total, moment)
    mesh = HexMesh(mesh.points, mesh.cells, mesh.conditions[:1], mesh.tractions)
    assert [half.axis for half in halve(mesh)[1]] == axes


def test_set_without_faces_has_no_traction():
    points, cells, _ = distorted_block(n=2)
    edge = (points[:, 2] == 1) & (points[:, 0] == 0)
    assert traction(points, cells, edge, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)) is None


VARIED = Path(__file__).with_name("varied.toml").read_text()


def test_variants(tmp_path):
    path = tmp_path / "bar.toml"
    path.write_text(VARIED)
    assert list(read_tables(path)) == ["bar-1-a", "bar-1-b", "bar-2-a", "bar-2-b"]
    case = read_case(path, "bar-2-b")
    assert case.name == "bar-2-b"
    assert case.materials[0].parameters == {"young_modulus": 3000.0, "poisson_ratio": 0.4}
    assert case.forces[0].moment == (1.0, 0.0, 0.0) and case.forces[0].total == (0.0, 0.0, 0.0)
    assert not read_case(path, "bar-1-a").forces
    assert find_case(tmp_path, "bar-1-b") == path
    assert find_case(tmp_path, "bar-1-c") is None
    with pytest.raises(
        InputError, match="has 4 variants; name one of them; known: bar-1-a, bar-1-b"
    ):
        read_case(path)
    with pytest.raises(InputError, match="has no case 'bar-1-c'"):
        read_case(path, "bar-1-c")


@pytest.mark.parametrize(
    "old, new, words",
    [
        ("moment = [1, 0, 0]", "moment = [1, 0]", "moment"),
        ("moment = [1, 0, 0]", "moments = [1, 0, 0]", "moments"),
        ('set = "tip", ', "", "set"),
        ("moment = [1, 0, 0]", 'total = [1, 0, 0], on = "nodes"', "on = 'nodes' must be 'faces'"),
    ],
)
def test_wrong_force(tmp_path, old, new, words):
    path = tmp_path / "bar.toml"
    path.write_text(VARIED.replace(old, new))
    with pytest.raises(InputError, match=words):
        read_case(path, "bar-2-b")
