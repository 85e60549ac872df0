"""Pressures that follow, weight, springs and several materials, against exact answers."""

import dataclasses

import numpy as np
import pytest

from blocks import ELEMENTS, affine, distorted_block
from case_file import Gravity, Material, read_case
from common.errors import InputError
from hexahedra import Attached, Condition, HexMesh, Surface
from newton import solve
from problem import MixedProblem
from symmetry import halve

STIFF = Material("neo-hookean", {"young_modulus": 9000.0, "poisson_ratio": 0.3}, 2000.0)
SOFT = Material("yeoh", {"c1": 500.0, "c2": 10.0, "c3": 1.0, "bulk_modulus": 5000.0}, 1000.0)


def _at(points, axis, value):
    return np.abs(points[:, axis] - value) < 1e-9


def _held(points, planes):
    """Conditions that hold one component on each of some planes through the origin."""
    return tuple(
        Condition(_at(points, axis, 0.0), (axis,), np.zeros_like(points)) for axis in planes
    )


@ELEMENTS
def test_a_body_under_pressure_shrinks_uniformly(make):
    """K (J - 1) = -p, on distorted elements; a dead load would give another answer."""
    points, cells, _ = distorted_block()
    pressed = tuple(Surface(_at(points, axis, 1.0), pressure=900.0) for axis in range(3))
    mesh = HexMesh(points, cells, _held(points, range(3)), surfaces=pressed)
    problem = make(mesh, [STIFF])
    outcome = solve(problem, 2, 1e-10)
    stretch = np.cbrt(1 - 900.0 / (9000.0 / 3 / (1 - 0.6)))
    exact = affine(points, (stretch - 1) * np.eye(3))
    assert np.abs(problem.nodal_displacement()[: len(points)] - exact).max() < 1e-11
    assert outcome.residual < 1e-12 and halve(mesh)[1] == []


@ELEMENTS
def test_layers_carry_the_same_stress(make):
    """Of two materials pressed together, sides held: the strains follow from two numbers."""
    points, cells, _ = distorted_block(n=4, distortion=0.0)
    materials = (points[cells].mean(axis=1)[:, 2] > 0.5).astype(int)
    sides = Condition(np.ones(len(points), bool), (0, 1), np.zeros_like(points))
    top = Condition(_at(points, 2, 1.0), (2,), np.full_like(points, -0.1))
    conditions = (sides, top, *_held(points, [2]))
    problem = make(HexMesh(points, cells, conditions, materials=materials), [STIFF, SOFT])
    solve(problem, 2, 1e-10)
    u = problem.nodal_displacement()[: len(points), 2]
    middle = u[_at(points, 2, 0.5)]
    assert np.ptp(middle) < 1e-12
    e_low, e_high = middle[0] / 0.5, (-0.1 - middle[0]) / 0.5

    def stress(e, modulus, bulk):
        """P33 of a uniaxial strain; modulus(x): twice the derivative by the first invariant x."""
        J, F = 1 + e, np.diag([1.0, 1.0, 1 + e])
        trace = np.trace(F @ F)
        x = J ** (-2 / 3) * trace - 3
        return modulus(x) * J ** (-2 / 3) * (J - trace / 3 / J) + bulk * (J - 1)

    low = stress(e_low, lambda x: 9000 / 2.6, 7500.0)
    high = stress(e_high, lambda x: 2 * (500 + 20 * x + 3 * x**2), 5000.0)
    assert abs(low / high - 1) < 1e-9


@ELEMENTS
@pytest.mark.parametrize("only_normal", [False, True])
def test_springs_carry_the_weight(make, only_normal):
    """The weight is k times the mean displacement times the area; nothing else holds the body. 500
    kg are attached to its upper face."""
    points, cells, _ = distorted_block(distortion=0.0)
    foot = _at(points, 2, 0.0)
    surfaces = (Surface(foot, stiffness=1e6, only_normal=only_normal),)
    held = _held(points, [0, 1]) if only_normal else ()
    loads = {"gravity": (Gravity((0.0, 0.0, -0.05)),)}
    loads["masses"] = (Attached(_at(points, 2, 1.0), 500.0),)
    mesh = HexMesh(points, cells, held, surfaces=surfaces, **loads)
    problem = make(mesh, [STIFF])
    solve(problem, 1, 1e-10)
    u = problem.nodal_displacement()[: len(points)]
    if make is MixedProblem:  # the corners of a quadratic face are not enough
        on_edge = sum(_at(points, axis, end).astype(int) for axis in (0, 1) for end in (0.0, 1.0))
        share = 0.5 ** on_edge[foot] / (len(cells) ** (1 / 3)) ** 2
        assert abs((share * u[foot, 2]).sum() * 1e6 / (-0.05 * 2500.0) - 1) < 1e-9
    assert (u[:, 2] < 0).all()


def test_hexahedra_fall_without_deforming():
    """Each vertex of the frustum of a pyramid has an eighth of its mass, and the weight of that.
    The integrals of the shape functions are larger at the larger face."""
    points, cells, _ = distorted_block(n=1, distortion=0.0)
    points[_at(points, 2, 1.0), :2] *= 0.5
    mesh = HexMesh(points, cells, (), gravity=(Gravity((0.0, 2.0, -10.0)),))
    loads = MixedProblem(mesh, [STIFF]).loads
    eighth = 2000.0 * (1.0 + 0.5 + 0.25) / 3 / 8
    assert np.abs(loads.masses / eighth - 1).max() < 1e-12
    weight = -loads.forces(lambda _curve: 1.0).reshape(-1, 3)
    assert np.abs(weight / eighth - [0.0, 2.0, -10.0]).max() < 1e-11


def test_loads_of_a_case_at_the_end_of_their_curves(tmp_path):
    path = tmp_path / "loads.toml"
    text = """
case = { name = "loads" }
material = { law = "neo-hookean", young_modulus = 1.0, poisson_ratio = 0.3, density = 7.0 }
pressure = [{ set = "a", value = 3.0, times = [0.0, 2.0], factors = [0.0, 1.0] }]
gravity = [{ value = [0.0, 1.0, 2.0] }, { value = [1.0, 0.0, 0.0], times = [0], factors = [3] }]
support = [{ set = "b", stiffness = 5.0, damping = 2.0, only_normal = true }]
"""
    path.write_text(text)
    case = read_case(path)
    assert case.pressures[0].value == 1.5
    assert [one.value for one in case.gravity] == [(0.0, 1.0, 2.0), (3.0, 0.0, 0.0)]
    assert dataclasses.astuple(case.supports[0]) == ("b", 5.0, True)
    assert case.materials[0].density == 7.0
    for wrong, new in (("stiffness = 5.0", "stiffness = 'a'"), ("value = 3.0", "valu = 3.0")):
        path.write_text(text.replace(wrong, new))
        with pytest.raises(InputError, match="support|pressure"):
            read_case(path)
