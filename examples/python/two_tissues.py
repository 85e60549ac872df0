"""The stiffness of two tissues from noisy displacements of the surface, with its uncertainty.

Usage: /usr/bin/python3 examples/python/two_tissues.py
A block of two layers is bent by a known force. Known are also the displacements of its free
surface, with noise of 2 % of the largest. Prints both moduli with their standard deviations and
the 95 % interval of one of them by its profile likelihood. Exit code 0.
"""

import sys
from pathlib import Path

import numpy as np

if __name__ == "__main__":
    root = Path(__file__).resolve().parents[2]
    sys.path.insert(0, str(root / "build" / "release" / "python"))

import sandglass as sg
from identification import fit, profile

TRUE = (12e3, 30e3)  # Pa
NOISE = 0.02  # of the largest displacement
SIZE, ELEMENTS = (0.04, 0.04, 0.1), (4, 4, 10)
QUANTILE = 3.841  # of chi squared with one degree of freedom, 95 %


def block(moduli):
    """The body, with the moduli (2,) of its layers in Pa."""
    laws = [
        sg.NeoHookean(young_modulus=E, poisson_ratio=0.45, density=1000, elements=layer)
        for E, layer in zip(moduli, "ab")
    ]
    loads = [
        sg.Displacement(set="base", value=(0, 0, 0)),
        sg.Force(set="head", total=(0.1, 0, 0)),
    ]
    sets = {"base": {"z": [0, 0]}, "head": {"z": [0.1, 0.1]}}
    layers = {"a": {"x": [0, 0.02]}, "b": {"x": [0.02, 0.04]}}
    mesh = sg.Box(size=SIZE, elements=ELEMENTS)
    return sg.Body(mesh, laws, loads, sets=sets, element_sets=layers)


def model(logarithms):
    """Displacements (k,) of the free surface, m, and their derivatives (k, 2) by log moduli."""
    moduli = np.exp(logarithms)
    solution = block(moduli).solve(name="tl-mean-dilatation")
    points = solution.points
    on = np.isclose(points, 0).any(axis=1) | np.isclose(points, SIZE).any(axis=1)
    seen = on & (points[:, 2] > 1e-9)
    changes = ([{"young_modulus": E} for E in row] for row in np.diag(moduli))
    columns = [solution.sensitivity(change)[seen].ravel() for change in changes]
    return solution.displacement[seen].ravel(), np.column_stack(columns)


def identify(rng):
    """(Fit, ends (2,) of the 95 % interval of the second modulus, Pa) of one measurement."""
    exact, _ = model(np.log(TRUE))
    noise = NOISE * np.abs(exact).max()
    measured = exact + noise * rng.standard_normal(exact.shape)
    found = fit(model, (20e3, 20e3), measured, noise)
    # The misfit is nearly a parabola: through three points it gives both ends.
    deviations = np.array([-2.0, 0.0, 2.0])
    values = found.parameters[1] * np.exp(deviations * found.relative_errors()[1])
    misfits = profile(model, found, measured, noise, 1, values) - found.misfit
    ends = np.roots(np.polyfit(np.log(values), misfits - QUANTILE, 2))
    return found, np.sort(np.exp(ends.real))


def main():
    """Prints what was found."""
    found, interval = identify(np.random.default_rng(0))
    for E, true, error in zip(found.parameters, TRUE, found.relative_errors()):
        print(f"{E:.0f} Pa +- {100 * error:.2f} % (true: {true:.0f})")
    print(f"the second within 95 %: {interval[0]:.0f} to {interval[1]:.0f} Pa")


if __name__ == "__main__":
    main()
