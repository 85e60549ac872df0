"""The examples find what they say they find."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "python")]

import module_folder  # noqa: E402

sys.path.insert(0, module_folder.FOLDER)

import identification  # noqa: E402
import silicone_beam  # noqa: E402
import stiffness_map  # noqa: E402
import two_tissues  # noqa: E402


def line_model(logarithms):
    """Values a + b x at five x, of parameters a and b."""
    a, b = np.exp(logarithms)
    x = np.arange(5.0)
    return a + b * x, np.column_stack([np.full(5, a), b * x])


def test_a_fit_has_the_covariance_of_linear_least_squares():
    """A straight line: parameters, covariance and misfit are known in closed form."""
    measured, error = np.array([1.1, 2.9, 5.2, 6.8, 9.1]), 0.2
    design = np.column_stack([np.ones(5), np.arange(5.0)])
    expected = np.linalg.lstsq(design, measured, rcond=None)[0]
    covariance = error**2 * np.linalg.inv(design.T @ design)
    found = identification.fit(line_model, [5.0, 0.5], measured, error)
    assert np.allclose(found.parameters, expected, rtol=1e-9)
    assert np.allclose(found.covariance, covariance / np.outer(expected, expected), rtol=1e-6)
    misfit = ((measured - design @ expected) ** 2).sum() / error**2
    assert abs(found.misfit / misfit - 1) < 1e-9


def test_a_profile_is_the_parabola_of_a_linear_problem():
    """The misfit grows by one at one standard deviation, with the other parameter fitted anew."""
    measured = np.array([1.1, 2.9, 5.2, 6.8, 9.1])
    found = identification.fit(line_model, [5.0, 0.5], measured, 0.2)
    deviation = found.parameters[1] * found.relative_errors()[1]
    at = found.parameters[1] + deviation * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    misfits = identification.profile(line_model, found, measured, 0.2, 1, at)
    assert np.allclose(misfits - found.misfit, [4.0, 1.0, 0.0, 1.0, 4.0], atol=1e-6)


def test_a_fit_that_does_not_converge_says_so():
    with pytest.raises(RuntimeError, match="no fit after 30 steps"):
        identification.fit(lambda x: (np.exp(-x), np.ones((1, 1))), [1.0], -1.0, 1.0)


def test_products_with_second_derivatives():
    """Of the sinking of the beam's markers by log E: differences of the sinking itself. Both are
    exact to a thousandth: displacements are nearly 1 / E, so that all derivatives are alike."""

    def sinking(logarithms):
        body = silicone_beam.beam(float(np.exp(logarithms[0])), 0.05, (5, 2, 2))
        body.tables.append(silicone_beam.sg.Relaxation(tolerance=1e-12))
        solution = body.solve(name="tl-mean-dilatation")
        weights = silicone_beam.marker_weights(solution).mean(axis=0)
        return solution, weights

    def value(logarithms):
        solution, weights = sinking(logarithms)
        return weights @ solution.displacement[solution.sets["end"], 2]

    def gradient(logarithms):
        solution, weights = sinking(logarithms)
        slope = np.zeros_like(solution.displacement)
        slope[solution.sets["end"], 2] = weights
        (material,) = solution.gradient(slope).materials
        return np.array([material["young_modulus"] * np.exp(logarithms[0])])

    at, h = np.log([276e3]), 0.02
    (found,) = identification.hessian_product(gradient, at, [1.0], step=0.01)
    expected = (value(at + h) - 2 * value(at) + value(at - h)) / h**2
    assert abs(found / expected - 1) < 1e-3


def test_the_modulus_of_the_beam_is_recovered():
    """From what the case's own element computes on a coarse mesh, exactly; 2 % of noise on three
    markers give the standard deviation 2 % / sqrt(3), as displacements are nearly 1 / E."""
    model = silicone_beam.model(0.0, elements=(10, 3, 3))
    measured, _ = model(np.log([250e3]))
    found = identification.fit(model, [100e3], measured, 0.02 * np.abs(measured))
    assert abs(found.parameters[0] / 250e3 - 1) < 1e-6
    assert abs(found.relative_errors()[0] / (0.02 / np.sqrt(3)) - 1) < 0.02


def test_the_experiment(capsys):
    """The modulus of the case is that of the finest mesh; meshes approach it from below."""
    silicone_beam.main()
    moduli = [int(E) for E in re.findall(r"E = (\d+) Pa", capsys.readouterr().out)]
    case = re.search(r"young_modulus = (\S+)", silicone_beam.CASE.read_text(encoding="utf-8"))
    assert moduli == sorted(moduli) and abs(moduli[-1] / float(case[1]) - 1) < 1e-3


def test_the_uncertainty_of_two_tissues(monkeypatch):
    """Errors over their standard deviations have a variance of one: that of 24 measurements is
    within .6 of it in 95 % of cases, and their mean within .41 of zero. The profile agrees with the
    covariance, because the problem is nearly linear."""
    monkeypatch.setattr(two_tissues, "ELEMENTS", (2, 2, 5))
    errors = []
    for seed in range(24):
        found, (low, high) = two_tissues.identify(np.random.default_rng(seed))
        deviation = found.relative_errors()[1]
        errors.append(np.log(found.parameters[1] / two_tissues.TRUE[1]) / deviation)
        width = 2 * np.sqrt(two_tissues.QUANTILE) * deviation
        assert abs(np.log(high / low) / width - 1) < 0.05
    assert abs(np.mean(errors)) < 0.41 and abs(np.var(errors) - 1) < 0.6


def test_a_stiff_inclusion_is_seen_from_the_surface():
    """The map correlates with the inclusion, and the soft part is found; the contrast is not
    reached: the penalty prefers smooth maps."""
    moduli, _, misfit = stiffness_map.stiffness_map(np.random.default_rng(1))
    inside = stiffness_map.true_moduli() == stiffness_map.STIFF
    assert misfit <= 1.0
    assert np.corrcoef(np.log(moduli), inside)[0, 1] > 0.8
    assert abs(np.median(moduli[~inside]) / stiffness_map.SOFT - 1) < 0.1
    assert 1.5 < np.median(moduli[inside]) / stiffness_map.SOFT < 3.5
