"""Contact with rigid obstacles: distances, and columns whose stress is known."""

import dataclasses

import numpy as np
import pytest

from blocks import ELEMENTS, distorted_block
from case_file import Contact as CasePair
from case_file import Material, read_case
from common.errors import InputError
from common.hexahedron import CUBE
from contact import Contact
from hexahedra import Condition, HexMesh, Touching, refine
from newton import solve
from obstacles import SHAPES, Obstacle
from problem import MixedProblem

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
    x = np.random.default_rng(1).uniform(-0.8, 0.8, (2000, 3))

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
    gap, pressure, force = _at_plate(problem)
    exact = E * (1 - 0.8**2) / 2 * 0.8
    assert np.abs(pressure / exact - 1).max() < 1e-8 and np.abs(gap).max() < 1e-10
    assert np.abs(force - [0, 0, -exact]).max() < 1e-8 * exact


@ELEMENTS
def test_a_penalty_gives_way(make):
    """The modulus lambda + 2 mu is E here, and the shortest edge 1/3."""
    mesh = _pressed(0.2, {"limit": False, "penalty": 2.0}, distortion=0.0)
    problem = make(mesh, COLUMN)
    solve(problem, 2, 1e-10)
    gap, pressure, force = _at_plate(problem)
    assert np.ptp(gap) < 1e-10
    stretch = 0.8 - gap[0]
    exact = E * (1 - stretch**2) / 2 * stretch
    assert np.abs(pressure / exact - 1).max() < 1e-8
    assert np.abs(pressure / (2.0 * E * -gap / (1 / 3)) - 1).max() < 1e-7
    assert np.abs(force - [0, 0, -exact]).max() < 1e-8 * exact


def test_the_softest_material_and_the_shortest_edge_count():
    """Of the elements that touch, not of those below them."""
    stiff, soft = ({"young_modulus": e, "poisson_ratio": 0.25} for e in (9e3, 5e3))
    materials = [Material("neo-hookean", one) for one in (stiff, soft)]
    mesh = _pressed(0.1, {"limit": False, "penalty": 3.0}, n=2, distortion=0.0)
    points = mesh.points * [2.0, 0.5, 1.0]
    top = points[mesh.cells].mean(axis=1)[:, 2] > 0.5
    for number, of_top, modulus in ((0, 1, 5e3), (1, 0, 9e3)):
        of_cells = np.where(top, of_top, number)
        problem = MixedProblem(
            dataclasses.replace(mesh, points=points, materials=of_cells), materials
        )
        problem.displacement.x.array.reshape(-1, 3)[:] = [0, 0, 0.01]
        _, pressure, _ = _at_plate(problem)
        assert np.allclose(pressure, 3.0 * modulus * 0.11 / 0.25, rtol=1e-6)


def test_an_obstacle_does_not_hold_back():
    """A plate that retreats, or does not arrive, leaves the column as it is."""
    mesh = _pressed(-0.05)
    problem = MixedProblem(mesh, COLUMN)
    solve(problem, 2, 1e-10)
    assert not problem.nodal_displacement().any()
    problem.loads.contacts[0].multipliers[:] = 100.0
    assert problem.augment() > 0 and not problem.loads.contacts[0].multipliers.any()


def test_meshes_that_are_split_touch_with_all_their_nodes():
    mesh = _pressed(0.2, n=2)
    problem = MixedProblem(refine(mesh), COLUMN)
    solve(problem, 2, 1e-10)
    gap, _, force = _at_plate(problem)
    assert len(gap) == 25 and abs(force[2] / (E * 0.18 * 0.8) + 1) < 1e-8


@pytest.mark.parametrize("name, inside", [("sphere", False), ("ellipsoid", True)])
def test_the_tangent_is_the_derivative_of_the_forces(name, inside):
    """Of the pressure and of the turning normal."""
    random = np.random.default_rng(2)
    x = random.uniform(-0.6, 0.6, (60, 3)) + PLACE
    obstacle = Obstacle("a", name, PARAMETERS[name], (0.1, 0.0, -0.1), inside)
    contact = Contact(obstacle, x, random.uniform(0.5, 2.0, len(x)), 30.0, 0.1)
    contact.multipliers[:] = random.uniform(0.0, 500.0, len(x))
    u = random.normal(scale=0.01, size=x.size)
    change = random.normal(scale=1e-6, size=x.size)
    moved = contact.forces(u + change, 0.5) - contact.forces(u - change, 0.5)
    expected = 2 * contact.tangent(u, 0.5) @ change
    assert expected.any() and np.abs(moved - expected).max() < 1e-8 * np.abs(expected).max()


# A rigid ball of radius R is pressed by d = a^2 / R into a half-space with E / (1 - nu^2) = E*:
# F = 4/3 E* a^3 / R, pressure 2 E* a / (pi R) sqrt(1 - r^2 / a^2). Strains are small: a = R / 100.
HERTZ = {"young_modulus": 1.40625e7, "poisson_ratio": 0.25}
E_STAR, RADIUS, CONTACT = 1.5e7, 10.0, 0.1


def _ball(size, across):
    """A quarter of a block under a ball, with so many elements across the contact.

    Elements are cubes there and double their edges further out. size: about that of the block, m.
    """
    h = 2 * CONTACT / across
    ticks = list(h * np.arange(across + 1))
    while ticks[-1] < size:
        ticks.append(ticks[-1] + 2 * (ticks[-1] - ticks[-2]))
    n = len(ticks)
    i, j, k = np.meshgrid(*[np.arange(n)] * 3, indexing="ij")
    points = np.stack([np.array(ticks)[i], np.array(ticks)[j], -np.array(ticks)[k]], axis=-1)
    first = np.stack([i, j, k], axis=-1)[:-1, :-1, :-1].reshape(-1, 1, 3)
    # The third axis points down, so that it takes the other order of corners.
    cells = (first + CUBE[[4, 5, 6, 7, 0, 1, 2, 3]]) @ [n * n, n, 1]
    points = points.reshape(-1, 3)
    base, top = points[:, 2] == -ticks[-1], points[:, 2] == 0
    zero = np.zeros_like(points)
    planes = (Condition(points[:, axis] == 0, (axis,), zero) for axis in (0, 1))
    ball = {"point": (0.0, 0.0, RADIUS), "radius": RADIUS}
    down = (0.0, 0.0, -(CONTACT**2) / RADIUS)
    touching = (Touching(top, Obstacle("top", "sphere", ball, down)),)
    return HexMesh(points, cells, (Condition(base, (0, 1, 2), zero), *planes), touching=touching)


def test_hertz():
    """The block is 200 contact radii high, where a half-space moves by half a percent."""
    problem = MixedProblem(_ball(20.0, 8), [Material("neo-hookean", HERTZ)])
    solve(problem, 2, 1e-9)
    (contact,) = problem.loads.contacts
    _, pressure, normal = contact.state(problem.displacement.x.array, 1.0)
    shares = contact.areas * pressure
    force = -4 * shares @ normal[:, 2]
    x = problem.displacement.function_space.tabulate_dof_coordinates()[contact.nodes]
    r2 = (x**2).sum(axis=1)
    radius = np.sqrt(2.5 * (shares @ r2) / shares.sum())  # the mean of r^2 is 2/5 a^2
    exact = 4 / 3 * E_STAR * CONTACT**3 / RADIUS
    assert abs(force / exact - 1) < 0.01
    assert abs(radius / CONTACT - 1) < 0.02
    assert abs(pressure[r2.argmin()] / (2 * E_STAR * CONTACT / np.pi / RADIUS) - 1) < 0.03


def test_obstacles_of_a_case(tmp_path):
    path = tmp_path / "press.toml"
    text = """
case = { name = "press" }
material = { law = "neo-hookean", young_modulus = 1.0, poisson_ratio = 0.3 }
[[obstacle]]
name = "tool"
set = "top"
shape = "capsule"
point = [0, 0, 1]
end = [1, 0, 1]
radius = 0.5
displacement = [0.0, 0.0, -2.0]
times = [0.0, 2.0]
factors = [0.0, 1.0]
penalty = 7.0
[[obstacle.move]]
displacement = [0.5, 0.0, 0.0]
[[obstacle.move]]
displacement = [0.0, 3.0, -1.0]
formula = "t/2"
[[obstacle]]
set = "all"
shape = "ellipsoid"
inside = true
point = [0, 0, 0]
half_sizes = [3, 2, 1]
[[contact]]
name = "pair"
set = "top"
other = "bottom"
penalty = 2.0
"""
    path.write_text(text)
    case = read_case(path)
    assert case.contacts == (CasePair("top", "bottom"),)
    tool, room = case.obstacles
    ends = {"point": (0.0, 0.0, 1.0), "end": (1.0, 0.0, 1.0), "radius": 0.5}
    assert tool == Obstacle("top", "capsule", ends, (0.5, 1.5, -1.5), penalty=7.0)
    assert room.inside and room.parameters["half_sizes"] == (3.0, 2.0, 1.0)
    for wrong, message, error in (
        ("capsule", "cone", "shape = 'cone' is not known"),
        ("radius = 0.5", "", "radius"),
        ("penalty", "friction", "friction"),
        ("inside", "outside", "unknown key"),
        ('"t/2"', '"t/2"\nradius = 1', r"obstacle\[0\]\S*move\[1\].radius: unknown key"),
        ('name = "press"', 'name = "press", answer = "dynamic"', "motion"),
        ('other = "bottom"', "", "contact.*other"),
        ("penalty = 2.0", "friction = 0.1", "with friction is not supported"),
    ):
        path.write_text(text.replace(wrong, message))
        with pytest.raises(InputError, match=error):
            read_case(path)


def _at_plate(problem):
    """Gaps (k,) in m, pressures (k,) in Pa and the force (3,) in N at full load."""
    u = getattr(problem, "function", problem.displacement).x.array
    (contact,) = problem.loads.contacts
    assert abs(contact.areas.sum() - 1) < 1e-12
    gap, pressure, normal = contact.state(u, 1.0)
    return gap, pressure, (contact.areas * pressure) @ normal
