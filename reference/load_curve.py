"""Curves of loads over time: a formula, or points joined by straight lines."""

import numpy as np

import formula
from common.errors import InputError
from common.records import entry

# The keys of a load's curve.
CURVE = ("times", "factors", "formula")


def factor_and_curve(where, table, moving):
    """The constant factor of a load, and in motion its curve, if it has one.

    In static equilibrium the factor is the curve's at its end, time 1.
    """
    curve = _curve(where, table)
    if curve is None:
        return 1.0, None
    return (1.0, curve) if moving else (curve(1.0), None)


def _curve(where, table):
    """The curve of a load as a function of the time in s, or None."""
    if "formula" in table:
        text = entry(where, table, "formula", str)

        def factor(time):
            try:
                return formula.evaluate(text, time)
            except InputError as error:
                raise InputError(f"{where}.formula: {error}") from error

        return factor
    if "times" not in table and "factors" not in table:
        return None
    times, factors = (entry(where, table, key, list) for key in ("times", "factors"))
    return lambda time: float(np.interp(time, times, factors))
