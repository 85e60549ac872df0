"""Identification: parameters of a body from what was measured on it, with their uncertainty.

A model is a function from the logarithms of p parameters to the k values that a measurement has,
and to their derivatives (k, p).
"""

from dataclasses import dataclass

import numpy as np

STEPS = 30
TOLERANCE = 1e-7  # of the last change of a logarithm


@dataclass(frozen=True)
class Fit:
    """A least-squares fit of the logarithms of p parameters to k measured values.

    parameters: (p,). covariance: (p, p) of their logarithms, for errors of the given size. misfit:
    the sum of squares of residuals over errors. solutions: the number of evaluated models.
    """

    parameters: np.ndarray
    covariance: np.ndarray
    misfit: float
    solutions: int

    def relative_errors(self):
        """The standard deviations (p,) of the parameters, relative to them."""
        return np.sqrt(np.diag(self.covariance))


def fit(model, start, measured, errors):
    """The Fit of a model by Gauss and Newton's method.

    start: (p,) parameters. measured: (k,). errors: standard deviations (k,) of these, or one for
    all. Raises RuntimeError if the steps do not converge.
    """
    logarithms = np.log(np.asarray(start, dtype=float))
    for step in range(1, STEPS + 1):
        values, derivatives = model(logarithms)
        residuals = (measured - values) / errors
        slopes = derivatives / np.broadcast_to(errors, values.shape)[:, None]
        change = np.linalg.lstsq(slopes, residuals, rcond=None)[0]
        change = np.clip(change, -1.0, 1.0)  # a factor of e at most
        logarithms = logarithms + change
        # The next residual differs from this one, linearised, by the square of the last change.
        if np.abs(change).max() < TOLERANCE:
            misfit = ((residuals - slopes @ change) ** 2).sum()
            covariance = np.linalg.inv(slopes.T @ slopes)
            return Fit(np.exp(logarithms), covariance, float(misfit), step)
    raise RuntimeError(f"no fit after {STEPS} steps: the last one was {np.abs(change).max():.1e}")


def profile(model, found, measured, errors, which, values):
    """The profile likelihood of one parameter: the misfit (n,) at each of its `values` (n,).

    All others are fitted anew at each value. found: a Fit, from which they start. Where the
    misfit is less than 3.84 above its minimum, the parameter is within its interval of confidence
    of 95 % (the quantile of chi squared for one parameter).
    """
    misfits = []
    others = np.delete(np.arange(len(found.parameters)), which)
    start = found.parameters[others]
    for value in values:

        def held(logarithms, value=value):
            full = np.insert(logarithms, which, np.log(value))
            computed, derivatives = model(full)
            return computed, derivatives[:, others]

        one = fit(held, start, measured, errors)
        misfits.append(one.misfit)
    return np.array(misfits)


def hessian_product(gradient, at, along, step=1e-3):
    """The product (p,) of the second derivatives of a scalar with a direction.

    gradient: a function from parameters (p,) to the derivatives (p,) of the scalar. at, along:
    (p,); `step` times `along` must be small against the scale on which derivatives vary. The
    fourth-order difference of four gradients: it costs four solutions with their adjoints, and its
    error is 4 step^4 / 120 of the fifth derivative along `along`, and the solutions' residual over
    `step`.
    """
    at, along = np.asarray(at, dtype=float), np.asarray(along, dtype=float)
    near, far = (gradient(at + k * step * along) - gradient(at - k * step * along) for k in (1, 2))
    return (8 * near - far) / (12 * step)
