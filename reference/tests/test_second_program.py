"""Goldens with the elements of other programs; loads and materials as in FEniCSx."""

import dataclasses
import json

import numpy as np
import pytest

import second_program
from blocks import MATERIALS, distorted_block
from case_file import Gravity, Material
from common.errors import InputError
from hexahedra import Condition, HexMesh, Surface, Touching, traction
from newton import solve
from obstacles import Obstacle
from problem import MixedProblem

SfepyProblem = pytest.importorskip("sfepy_problem").SfepyProblem
GetfemProblem = pytest.importorskip("getfem_problem").GetfemProblem

# Both solve the same equations to a residual near rounding; conditions of a few thousand remain.
SAME = 1e-11
YEOH = Material("yeoh", {"c1": 500.0, "c2": 200.0, "c3": 50.0, "bulk_modulus": 4e4}, 1500.0)


@pytest.mark.parametrize("name", ["bending-1-nu0.49", "hertz-4"])
def test_a_golden_is_found_again(name):
    record = second_program.distance(name)
    assert record["distance"] < second_program.LIMIT and record["elements"] > 0


def test_another_poisson_ratio_is_noticed():
    def changed(materials):
        ratio = materials[0].parameters["poisson_ratio"] - 0.001
        parameters = materials[0].parameters | {"poisson_ratio": ratio}
        return (dataclasses.replace(materials[0], parameters=parameters),)

    assert second_program.distance("bending-1-nu0.49", changed)["distance"] > 1e-5


def test_every_golden_is_compared():
    records = json.loads(second_program.STORE.read_text())["records"]
    assert [record["case"] for record in records] == second_program.compared()
    assert all(record["distance"] < second_program.LIMIT for record in records)


def loaded_block(stiff, only_normal, weight):
    """A block of two materials under a follower pressure, springs, a dead traction and weight.

    With weight, its elements are parallelepipeds: there both programs have the same nodal weights.
    """
    points, cells, _ = distorted_block(n=2, distortion=0.0 if weight else 0.15)
    foot, top, side = points[:, 2] < 1e-9, points[:, 2] > 1 - 1e-9, points[:, 0] < 1e-9
    soft = dataclasses.replace(MATERIALS[0], density=1000.0)
    mesh = HexMesh(
        points,
        cells,
        (Condition(foot & side, (0, 1, 2), np.zeros_like(points)),),
        (traction(points, cells, top, (10.0, 20.0, 30.0), (5.0, 0.0, 1.0)),),
        (points[cells].mean(axis=1)[:, 0] > 0.5).astype(int),
        (Surface(side, pressure=200.0), Surface(foot, stiffness=5e4, only_normal=only_normal)),
        (Gravity((0.01, 0.02, -0.03)),) if weight else (),
    )
    if weight:  # slanted elements; the conditions above are on the cube's faces
        slant = np.array([[1.0, 0.2, 0.1], [0.0, 1.0, 0.3], [0.0, 0.0, 1.0]])
        mesh = dataclasses.replace(mesh, points=points @ slant.T)
    return mesh, [soft, stiff]


STIFF = Material("neo-hookean", {"young_modulus": 30000.0, "poisson_ratio": 0.3}, 2000.0)


@pytest.mark.parametrize(
    ("program", "stiff", "only_normal"),
    [
        (SfepyProblem, STIFF, False),
        (GetfemProblem, STIFF, True),
        (GetfemProblem, YEOH, False),
    ],
)
@pytest.mark.parametrize("weight", [False, True])
def test_materials_and_loads(program, stiff, only_normal, weight):
    mesh, materials = loaded_block(stiff, only_normal, weight)
    answers = []
    for problem in (program(mesh, materials), MixedProblem(mesh, materials)):
        solve(problem, 2, 1e-12)
        answers.append(problem.nodal_displacement())
    assert np.abs(answers[0]).max() > 0.01
    assert np.abs(answers[0] - answers[1]).max() < SAME * np.abs(answers[1]).max()


# Obstacles rise into the foot of the block; the cavity lifts its corners.
OBSTACLES = {
    "plane": ({"point": [0.0, 0.0, 0.0], "normal": [0.2, 0.0, 2.0]}, False, 0.04),
    "sphere": ({"point": [0.6, 0.4, -0.7], "radius": 0.7}, False, 0.04),
    "ellipsoid": ({"point": [0.6, 0.4, -0.5], "half_sizes": [0.9, 0.7, 0.5]}, False, 0.04),
    "cavity": ({"point": [0.5, 0.5, 0.5], "half_sizes": [0.9, 1.0, 0.8]}, True, 0.1),
}


@pytest.mark.parametrize("name", OBSTACLES)
def test_obstacles(name):
    """Distorted elements whose weight and contact are the nodes', as in the golden."""
    parameters, inside, rise = OBSTACLES[name]
    points, cells, _ = distorted_block(n=2)
    foot, top = points[:, 2] < 1e-9, points[:, 2] > 1 - 1e-9
    shape = "ellipsoid" if inside else name
    obstacle = Obstacle("foot", shape, parameters, (0.0, 0.0, rise), inside)
    mesh = HexMesh(
        points,
        cells,
        (Condition(top, (0, 1, 2), np.zeros_like(points)),),
        gravity=(Gravity((0.01, 0.0, -0.03)),),
        touching=(Touching(foot, obstacle),),
    )
    materials = [dataclasses.replace(MATERIALS[0], density=1000.0)]
    problems = GetfemProblem(mesh, materials), MixedProblem(mesh, materials)
    answers = []
    for problem in problems:
        solve(problem, 2, 1e-12)
        answers.append(problem.nodal_displacement())
    (pressures,) = problems[1].multipliers()
    assert (pressures > 0).any()
    assert np.abs(answers[0] - answers[1]).max() < SAME * np.abs(answers[1]).max()


def test_unsupported_problems_are_refused(capsys):
    points, cells, boundary = distorted_block(n=2)
    held = (Condition(boundary, (0, 1, 2), np.zeros_like(points)),)
    with pytest.raises(InputError, match="no term for the law 'yeoh'"):
        SfepyProblem(HexMesh(points, cells, held), [YEOH])
    springs = (Surface(boundary, stiffness=1.0, only_normal=True),)
    with pytest.raises(InputError, match="springs along the normal"):
        SfepyProblem(HexMesh(points, cells, held, surfaces=springs), MATERIALS)
    with pytest.raises(InputError, match="there is no weak form of 'ogden' for GetFEM"):
        second_program.second_problem(HexMesh(points, cells, held), [Material("ogden", {})])
    box = Obstacle("foot", "box", {"point": [0.0] * 3, "half_sizes": [1.0] * 3})
    touching = (Touching(boundary, box),)
    with pytest.raises(InputError, match="shape 'box' .*; allowed: plane, sphere, ellipsoid"):
        second_program.second_problem(HexMesh(points, cells, held, touching=touching), MATERIALS)
    assert second_program.main(["colum"]) == 2
    assert "did you mean 'column'?" in capsys.readouterr().err
