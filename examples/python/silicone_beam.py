"""Young's modulus of the silicone beam from motion capture, and what it predicts.

Usage: /usr/bin/python3 examples/python/silicone_beam.py
The modulus is fitted to the beam that bends under its own weight, the only load whose place is
beyond doubt; the two masses hung on its end are predictions. The element is the golden's,
tl-mean-dilatation, on three meshes, of which the second is that of the case. Exit code 0.
"""

import sys
import time
import tomllib
from pathlib import Path

import numpy as np

if __name__ == "__main__":
    root = Path(__file__).resolve().parents[2]
    sys.path.insert(0, str(root / "build" / "release" / "python"))

import sandglass as sg
from identification import fit

MESHES = ((10, 3, 3), (20, 6, 6), (40, 12, 12))
CASE = Path(__file__).resolve().parents[2] / "cases" / "silicone-beam.toml"


def loads():
    """{name: (mass on the edge in kg, measured displacements (3,) in m, their scatter (3,))}."""
    with open(CASE, "rb") as file:
        variants = tomllib.load(file)["variants"]["weight"]
    found = {}
    for one in variants:
        values = [(m["value"], m["scatter"]) for m in one["measured"]]
        mass = sum(m["total"] for m in one.get("mass", ()))
        found[one["name"]] = (mass, *np.transpose(values))
    return found


def beam(modulus, mass, elements=(20, 6, 6)):
    """The body of the case, with a Young's modulus in Pa and a mass in kg."""
    tables = [
        sg.Displacement(set="clamp", value=(0, 0, 0)),
        sg.Gravity(value=(0, 0, -9.807)),
        sg.Mass(set="edge", total=mass),
    ]
    sets = {"clamp": {"x": [0, 0]}, "end": {"x": [0.1, 0.1]}}
    sets["edge"] = {"x": [0.1, 0.1], "z": [0.03, 0.03]}
    law = sg.NeoHookean(young_modulus=modulus, poisson_ratio=0.499, density=1070)
    return sg.Body(sg.Box(size=(0.1, 0.03, 0.03), elements=elements), law, tables, sets=sets)


def marker_weights(solution):
    """The weights (3, k) with which the k nodes of the end add up to the three markers.

    A marker moves as the linear field nearest to the motion of the end's nodes.
    """
    with open(CASE, "rb") as file:
        places = [m["at"] for m in tomllib.load(file)["variants"]["weight"][0]["measured"]]
    ends = solution.points[solution.sets["end"]]
    terms = np.column_stack([np.ones(len(ends)), ends[:, 1:]])
    at_markers = np.column_stack([np.ones(3), np.array(places)[:, 1:]])
    return at_markers @ np.linalg.pinv(terms)


def sinking(solution, field):
    """The vertical components (3,) of a nodal field (n, 3) at the markers."""
    return marker_weights(solution) @ field[solution.sets["end"], 2]


def model(mass, method="tl-mean-dilatation", elements=(20, 6, 6), **settings):
    """A model for identification.fit: displacements of the markers (m) from log(modulus)."""

    def evaluate(logarithms):
        modulus = float(np.exp(logarithms[0]))
        solution = beam(modulus, mass, elements).solve(name=method, **settings)
        slope = solution.sensitivity({"young_modulus": modulus})  # by the logarithm
        return sinking(solution, solution.displacement), sinking(solution, slope)[:, None]

    return evaluate


def main():
    """Prints fits on finer and finer meshes, and the predictions of the last one."""
    all_loads = loads()
    mass, measured, _ = all_loads["0g"]
    modulus = 100e3
    for elements in MESHES:
        started = time.perf_counter()
        # The markers differ by more than their repetitions, so that all count alike.
        found = fit(model(mass, elements=elements), [modulus], measured, 1e-4)
        seconds = time.perf_counter() - started
        modulus = found.parameters[0]
        error = found.relative_errors()[0] * np.sqrt(found.misfit / 2)  # two degrees of freedom
        print(
            f"{' x '.join(map(str, elements))}: E = {modulus:.0f} Pa +- {100 * error:.1f} %, "
            f"{found.solutions} solutions in {seconds:.2f} s"
        )
    for name, (mass, measured, scatter) in all_loads.items():
        computed, _ = model(mass, elements=elements)(np.log([modulus]))
        numbers = zip(1e3 * computed, 1e3 * measured, 1e3 * scatter)
        words = ", ".join(f"{c:.2f} ({m:.2f} +- {s:.2f})" for c, m, s in numbers)
        print(f"{name}: computed (measured), mm: {words}")


if __name__ == "__main__":
    main()
