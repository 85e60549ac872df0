"""Contact with rigid obstacles: distances, and columns whose stress is known."""

import dataclasses

import numpy as np
import pytest

from blocks import ELEMENTS, distorted_block, with_hanging_nodes
from case_file import Material, read_case
from common.errors import InputError
from hexahedra import Condition, HexMesh, Touching, refine
from newton import solve
from obstacles import SHAPES, Obstacle
from problem import MixedProblem
from tied_problem import TiedProblem

PLACE = np.array([0.1, -0.2, 0.3])
PARAMETERS = {
    "plane": {"point": PLACE, "normal": (0.3, -2.0, 1.0)},
    "sphere": {"point": PLACE, "radius": 0.4},
    "capsule": {"point": PLACE, "end": (0.5, 0.4, 0.2), "radius": 0.3},
    "cylinder": {"point": PLACE, "end": (0.5, 0.4, 0.2), "radius": 0.3},
    "box": {"point": PLACE, "half_sizes": (0.5, 0.3, 0.4)},
    "ellipsoid": {"point": PLACE, "half_sizes": (0.5, 0.3, 0.4)},
}


def _difference(function, x, h=1e-5):
    """The derivative of a function of points (k, 3) by central differences, in the last axis."""
    steps = h * np.eye(3)
    return np.stack([(function(x + s) - function(x - s)) / (2 * h) for s in steps], axis=-1)


@pytest.mark.parametrize("name", SHAPES)
def test_normals_and_curvatures_are_derivatives_of_the_distance(name):
    x = np.random.default_rng(1).uniform(-1.5, 1.5, (400, 3))

    def distance(x):
        return SHAPES[name](x, **PARAMETERS[name])

    # Deep within, distances have ridges where the nearest point of the surface jumps.
    x = x[distance(x)[0] > -0.1]
    d, normal, curvature = distance(x)
    assert (d < 0).any() and (d > 0).any()
    assert np.abs(np.linalg.norm(normal, axis=1) - 1).max() < 1e-12
    # Differences that straddle the edge between two parts of a surface err in a few points.
    for found, exact in (
        (_difference(lambda x: distance(x)[0], x), normal),
        (_difference(lambda x: distance(x)[1], x), curvature),
    ):
        error = np.abs(found - exact).reshape(len(x), -1).max(axis=1)
        assert np.mean(error > 1e-7) < 0.01
    # The nearest point is on the surface.
    assert np.abs(distance(x - d[:, None] * normal)[0]).max() < 1e-12


@pytest.mark.parametrize(
    "name, x, expected",
    [
        ("plane", PLACE + [0.3 + 1.0, -2.0, 1.0], (0.09 + 4 + 1 + 0.3) / np.sqrt(5.09)),
        ("sphere", PLACE + [0, 0, 1.0], 0.6),
        ("capsule", PLACE - np.array([0.4, 0.6, -0.1]) / np.sqrt(0.53), 0.7),
        ("capsule", PLACE + 0.5 * np.array([0.4, 0.6, -0.1]) + [0.6, -0.4, 0], np.sqrt(0.52) - 0.3),
        ("cylinder", PLACE + 9 * np.array([0.4, 0.6, -0.1]) + [0.6, -0.4, 0], np.sqrt(0.52) - 0.3),
        ("box", PLACE + [0.8, 0.7, 0.1], 0.5),
        ("box", PLACE - [0.1, 0.2, 0.1], -0.1),
        ("ellipsoid", PLACE - [0, 0, 0.35], -0.05),
        ("ellipsoid", PLACE + [0, 1.3, 0], 1.0),
    ],
)
def test_distances(name, x, expected):
    distance, _, _ = SHAPES[name](np.array([x]), **PARAMETERS[name])
    assert abs(distance[0] - expected) < 1e-12


def test_a_cavity_turns_the_signs():
    room = Obstacle("a", "sphere", {"point": (0, 0, 0), "radius": 1.0}, (0.5, 0, 0), inside=True)
    gap, normal, curvature = room.gap(np.array([[0.9, 0.0, 0.0]]), 1.0)
    assert abs(gap[0] - 0.6) < 1e-15 and np.allclose(normal, [[-1, 0, 0]])
    assert np.allclose(curvature[0], -np.diag([0, 1, 1]) / 0.4)


E = 3000.0
COLUMN = [Material("st-venant-kirchhoff", {"young_modulus": E, "poisson_ratio": 0.0})]


def _pressed(depth, obstacle=None, **block):
    """A unit cube on a frictionless floor, with a plate that comes down on it by a depth, m."""
    points, cells, _ = distorted_block(**block)
    plate = Obstacle("top", "plane", {"point": (0, 0, 1.1), "normal": (0, 0, -2.0)})
    plate = dataclasses.replace(plate, displacement=(0, 0, -0.1 - depth), **obstacle or {})
    held = tuple(
        Condition(points[:, axis] == 0, (axis,), np.zeros_like(points)) for axis in range(3)
    )
    return HexMesh(points, cells, held, touching=(Touching(points[:, 2] == 1, plate),))


@ELEMENTS
def test_a_column_is_pressed_by_a_plate(make):
    """Without lateral strain P33 = E (s^2 - 1)/2 s, s the stretch; the plate takes the force."""
    mesh = _pressed(0.2)
    problem = make(mesh, COLUMN)
    solve(problem, 2, 1e-10)
    u = problem.nodal_displacement()[: len(mesh.points)]
    assert np.abs(u - mesh.points * [0, 0, -0.2]).max() < 1e-9
    (contact,) = problem.loads.contacts
    gap, pressure, normal = contact.state(problem_function(problem), 1.0)
    exact = -E * (0.8**2 - 1) / 2 * 0.8
    assert np.abs(pressure / exact - 1).max() < 1e-8 and np.abs(gap).max() < 1e-10
    assert abs(contact.areas.sum() - 1) < 1e-12
    force = contact.forces(problem_function(problem), 1.0).reshape(-1, 3).sum(axis=0)
    assert np.abs(force - [0, 0, exact]).max() < 1e-7 * exact


def problem_function(problem):
    """The displacement of the nodes as Loads has it."""
    return getattr(problem, "function", problem.displacement).x.array
