"""The golden's problem with the terms of another program; loads and materials as in FEniCSx."""

import dataclasses
import json

import numpy as np
import pytest

import second_golden
from blocks import MATERIALS, distorted_block
from case_file import Material
from common.errors import InputError
from hexahedra import Condition, HexMesh, Surface, traction
from newton import solve
from problem import GOLDEN, MixedProblem

SfepyProblem = pytest.importorskip("sfepy_problem").SfepyProblem

# Both solve the same equations to a residual near rounding; conditions of a few thousand remain.
SAME = 1e-11


def test_a_golden_is_found_again():
    record = second_golden.distance("bending-1-nu0.49")
    assert record["distance"] < second_golden.LIMIT and record["elements"] > 0


def test_another_poisson_ratio_is_noticed():
    def changed(materials):
        parameters = materials[0].parameters | {"poisson_ratio": 0.489}
        return (dataclasses.replace(materials[0], parameters=parameters),)

    assert second_golden.distance("bending-1-nu0.49", changed)["distance"] > 1e-5


def test_every_golden_is_compared_or_has_a_reason():
    records = json.loads(second_golden.STORE.read_text())["records"]
    assert [record["case"] for record in records] == sorted(second_golden.stored("golden"))
    for record in records:
        assert ("reason" in record) != (record.get("distance", 1.0) < second_golden.LIMIT)
    assert sum("reason" in record for record in records) <= 1


def test_materials_and_loads():
    """Two materials, weight, a pressure that follows, springs, a dead traction: all at once."""
    points, cells, _ = distorted_block(n=3)
    foot, top, side = points[:, 2] < 1e-9, points[:, 2] > 1 - 1e-9, points[:, 0] < 1e-9
    stiff = Material("neo-hookean", {"young_modulus": 30000.0, "poisson_ratio": 0.3}, 2000.0)
    soft = dataclasses.replace(MATERIALS[0], density=1000.0)
    mesh = HexMesh(
        points,
        cells,
        (Condition(foot & side, (0, 1, 2), np.zeros_like(points)),),
        (traction(points, cells, top, (10.0, 20.0, 30.0), (5.0, 0.0, 1.0)),),
        (points[cells].mean(axis=1)[:, 0] > 0.5).astype(int),
        (Surface(side, pressure=200.0), Surface(foot, stiffness=5e4)),
        (0.01, 0.02, -0.03),
    )
    answers = []
    for problem in (SfepyProblem(mesh, [soft, stiff]), MixedProblem(mesh, GOLDEN, [soft, stiff])):
        solve(problem, 2, 1e-12)
        answers.append(problem.nodal_displacement())
    assert np.abs(answers[0]).max() > 0.01
    assert np.abs(answers[0] - answers[1]).max() < SAME * np.abs(answers[1]).max()


def test_what_cannot_be_said_is_refused(capsys):
    points, cells, boundary = distorted_block(n=2)
    held = (Condition(boundary, (0, 1, 2), np.zeros_like(points)),)
    with pytest.raises(InputError, match="no term for the law 'yeoh'"):
        SfepyProblem(HexMesh(points, cells, held), [Material("yeoh", {})])
    springs = (Surface(boundary, stiffness=1.0, only_normal=True),)
    with pytest.raises(InputError, match="springs along the normal"):
        SfepyProblem(HexMesh(points, cells, held, surfaces=springs), MATERIALS)
    assert second_golden.main(["colum"]) == 2
    assert "did you mean 'column'?" in capsys.readouterr().err
