"""A map of stiffness, element by element, from noisy displacements of the surface.

Usage: /usr/bin/python3 examples/python/stiffness_map.py
A block with a stiff inclusion is sheared and pulled by forces. Known are these and the
displacements of its surface, with noise of 0.3 % of the largest. Each element has a Young's modulus
of its own. Minimised is the misfit over the noise plus a penalty on the differences of log E
between elements that share a face; its weight is the largest for which the misfit is that of the
noise (Morozov's principle). Exit code 0.
"""

import sys
from pathlib import Path

import numpy as np
import scipy.optimize

if __name__ == "__main__":
    root = Path(__file__).resolve().parents[2]
    sys.path.insert(0, str(root / "build" / "release" / "python"))

import sandglass as sg

ELEMENTS = (4, 4, 6)
SIZE = (0.04, 0.04, 0.06)
SOFT, STIFF = 3e3, 9e3  # Pa
NOISE = 0.003  # of the largest displacement


def block(moduli):
    """The body with a Young's modulus (Pa) for each element (m,)."""
    laws = [
        sg.NeoHookean(young_modulus=E, poisson_ratio=0.45, density=1000, elements=f"e{n}")
        for n, E in enumerate(moduli)
    ]
    tables = [
        sg.Displacement(set="base", value=(0, 0, 0)),
        sg.Force(set="top", total=(0.15, 0, 0.4)),
        sg.Force(set="side", total=(0.2, 0.1, 0)),
    ]
    sets = {"base": {"z": [0, 0]}, "top": {"z": [SIZE[2]] * 2}, "side": {"x": [SIZE[0]] * 2}}
    parts = {f"e{n}": np.array([n]) for n in range(len(moduli))}
    mesh = sg.Box(size=SIZE, elements=ELEMENTS)
    return sg.Body(mesh, laws, tables, sets=sets, element_sets=parts)


def centres():
    """The centres (m, 3) of the elements, m, in the order of the mesh."""
    return (
        sg.Mesh.of(sg.Box(size=SIZE, elements=ELEMENTS))
        .points[sg.Mesh.of(sg.Box(size=SIZE, elements=ELEMENTS)).cells]
        .mean(axis=1)
    )


def true_moduli():
    """The moduli (m,) to be found: a stiff cube in a soft block, Pa."""
    inside = (np.abs(centres() - (0.02, 0.02, 0.035)) < 0.0125).all(axis=1)
    return np.where(inside, STIFF, SOFT)


def surface(points):
    """The nodes of the surface that are not held."""
    on = np.isclose(points, 0).any(axis=1) | np.isclose(points, SIZE).any(axis=1)
    return np.flatnonzero(on & (points[:, 2] > 1e-9))


def neighbours():
    """The pairs (k, 2) of elements that share a face."""
    number = np.lexsort(centres().round(9).T[::-1]).reshape(ELEMENTS)
    pairs = [
        np.stack([np.delete(number, -1, axis).ravel(), np.delete(number, 0, axis).ravel()], axis=1)
        for axis in range(3)
    ]
    return np.concatenate(pairs)


def measure(rng):
    """Displacements (n, 3) of a block with the true moduli, m, and the noise added to each, m."""
    exact = block(true_moduli()).solve(name="tl-mean-dilatation").displacement
    noise = NOISE * np.linalg.norm(exact, axis=1).max()
    return exact + noise * rng.standard_normal(exact.shape), noise


def identify(measured, noise, weight, start):
    """(moduli (m,), mean square of residuals over the noise): the minimum for a weight.

    start: log of moduli (m,).
    """
    pairs = neighbours()

    def objective(logarithms):
        solution = block(np.exp(logarithms)).solve(name="tl-mean-dilatation")
        nodes = surface(solution.points)
        residuals = np.zeros_like(measured)
        residuals[nodes] = (solution.displacement - measured)[nodes] / noise
        slope = solution.gradient(residuals / noise).stiffness  # E scales an element's stiffness
        jumps = logarithms[pairs[:, 0]] - logarithms[pairs[:, 1]]
        np.add.at(slope := np.array(slope), pairs[:, 0], weight * jumps)
        np.add.at(slope, pairs[:, 1], -weight * jumps)
        objective.misfit = (residuals**2).sum() / (3 * len(nodes))
        return 0.5 * (residuals**2).sum() + 0.5 * weight * (jumps**2).sum(), slope

    limits = {"maxiter": 60, "ftol": 1e-6}
    found = scipy.optimize.minimize(objective, start, jac=True, method="L-BFGS-B", options=limits)
    objective(found.x)
    return np.exp(found.x), objective.misfit


def stiffness_map(rng, weights=(100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0)):
    """(moduli (m,), weight, misfit): of the first weight whose misfit is at most that of noise."""
    measured, noise = measure(rng)
    start = np.full(len(true_moduli()), np.log(np.sqrt(SOFT * STIFF)))
    for weight in weights:
        moduli, misfit = identify(measured, noise, weight, start)
        if misfit <= 1.0:
            break
        start = np.log(moduli)
    return moduli, weight, misfit


def main():
    """Prints what was found."""
    moduli, weight, misfit = stiffness_map(np.random.default_rng(1))
    inside = true_moduli() == STIFF
    print(
        f"weight {weight:g}, misfit {misfit:.2f}: {np.median(moduli[inside]):.0f} Pa inside "
        f"(true: {STIFF:.0f}), {np.median(moduli[~inside]):.0f} Pa outside (true: {SOFT:.0f})"
    )


if __name__ == "__main__":
    main()
