"""Derivatives of static answers against FEniCSx's, for the same element: tl-mean-dilatation."""

import numpy as np
import pytest
from command_line import ROOT

import sandglass as sg

pytest.importorskip("dolfinx")

import newton  # noqa: E402 (reference/ needs dolfinx)
from gradient import adjoint  # noqa: E402
from mesh_file import case_with_mesh  # noqa: E402
from problem import MixedProblem  # noqa: E402

# Found: 5e-9 in the beam and 9e-8 with two materials. Residuals of 1e-12 leave 1e-9 of adjoints,
# and the sums over the elements of a material cancel up to a hundredfold. Another element is off
# by 0.1.
AGREEMENT = 1e-6


def distance(found, expected):
    return np.abs(found - expected).max() / np.abs(expected).max()


def oracle(name, variant=None):
    """The HexMesh of a case, dJ/du of a scalar J linear in u, and FEniCSx's Adjoint."""
    case, mesh, _ = case_with_mesh(ROOT / "cases" / f"{name}.toml", variant)
    problem = MixedProblem(mesh, case.materials)
    newton.solve(problem, 10, 1e-12)
    slope = np.random.default_rng(4).standard_normal(mesh.points.shape)
    return mesh, slope, adjoint(problem, case.materials, slope)


def compare(solution, mesh, slope, expected):
    """The largest relative distances of all derivatives."""
    assert np.array_equal(solution.points, mesh.points)
    found = solution.gradient(slope)
    errors = [distance(found.forces, expected.forces)]
    if np.abs(expected.imposed).max() > 0:
        errors.append(distance(found.imposed, expected.imposed))
    for own, expected_own in zip(found.materials, expected.parameters, strict=True):
        errors += [abs(own[name] / values.sum() - 1) for name, values in expected_own.items()]
    return found, max(errors)


@pytest.fixture(scope="module")
def silicone():
    """A beam under its weight and a mass."""
    return oracle("silicone-beam", "silicone-beam-52g")


def silicone_body():
    loads = [
        sg.Displacement(set="clamp", value=(0, 0, 0)),
        sg.Gravity(value=(0, 0, -9.807)),
        sg.Mass(set="edge", total=0.052),
        sg.Relaxation(tolerance=1e-12),
    ]
    sets = {"clamp": {"x": [0, 0]}, "edge": {"x": [0.1, 0.1], "z": [0.03, 0.03]}}
    law = sg.NeoHookean(young_modulus=276e3, poisson_ratio=0.499, density=1070)
    mesh = sg.Box(size=(0.1, 0.03, 0.03), elements=(20, 6, 6))
    return sg.Body(mesh, law, loads, sets=sets)


def test_a_beam_under_loads(silicone):
    mesh, slope, expected = silicone
    solution = silicone_body().solve(name="tl-mean-dilatation")
    found, error = compare(solution, mesh, slope, expected)
    assert error < AGREEMENT
    per_element = 276e3 * expected.parameters[0]["young_modulus"]
    assert distance(found.stiffness, per_element) < AGREEMENT


def test_two_materials_under_an_imposed_displacement():
    mesh, slope, expected = oracle("stiff-core")
    body = sg.Body.read(str(ROOT / "cases" / "stiff-core.toml"))
    body.tables = [*body.tables, sg.Relaxation(tolerance=1e-12)]
    _, error = compare(body.solve(name="tl-mean-dilatation"), mesh, slope, expected)
    assert error < AGREEMENT


def test_another_element_has_other_derivatives(silicone):
    """The comparison can fail: one point and a control are 10 % away."""
    solution = silicone_body().solve(name="tl-perturbation")
    _, error = compare(solution, *silicone)
    assert error > 0.01
