"""What gradients cost, over the answers that they belong to.

Usage: /usr/bin/python3 bench/gradient_costs.py [--elements N] [--repetitions N]
A block is stretched, at rest and in a motion of 400 steps. Timed in turn are `Body.solve` and
`Solution.gradient` of a smooth scalar, by all parameters and without those of laws; printed are
medians of the ratios. Needs the Python module.
Exit codes: 0 done, 2 bad usage or input.
"""

import statistics
import sys
import time
from pathlib import Path

if __name__ == "__main__":
    TREE = Path(__file__).resolve().parent.parent
    sys.path[1:1] = [str(TREE), str(TREE / "build" / "release" / "python")]

import sandglass as sg
from common.command import command_line, option

STEP, STEPS = 2e-4, 400
YEOH = {"c1": 500.0, "c2": 20.0, "c3": 1.0, "bulk_modulus": 16e3}  # Pa


def neo_hookean(ratio):
    return sg.NeoHookean(young_modulus=3e3, poisson_ratio=ratio, density=1000)


# Title, law, method.
AT_REST = [
    ("tl-perturbation", neo_hookean(0.45), "tl-perturbation"),
    ("tl-mean-dilatation", neo_hookean(0.45), "tl-mean-dilatation"),
    ("tl-mean-dilatation, nu 0.4999", neo_hookean(0.4999), "tl-mean-dilatation"),
    ("tl-energy-sampling", neo_hookean(0.45), "tl-energy-sampling"),
]
IN_MOTION = [
    ("tl-perturbation, 2 parameters", neo_hookean(0.45), "tl-perturbation"),
    ("tl-mean-dilatation, 2 parameters", neo_hookean(0.45), "tl-mean-dilatation"),
    ("tl-perturbation, 4 parameters", sg.Yeoh(**YEOH, density=1000), "tl-perturbation"),
]


def body(law, elements, moves):
    """A block of about this number of elements, stretched by a tenth and bent."""
    n = max(1, round((elements / 2) ** (1 / 3)))
    loads = [
        sg.Displacement(set="base", value=(0, 0, 0)),
        sg.Displacement(set="head", value=(0.01, 0, 0.01)),
    ]
    if moves:
        loads.append(sg.Dynamics(duration=STEP * STEPS, time_step=STEP, frames=4))
    sets = {"base": {"z": [0, 0]}, "head": {"z": [0.1, 0.1]}}
    mesh = sg.Box(size=(0.05, 0.05, 0.1), elements=(n, n, 2 * n))
    return sg.Body(mesh, law, loads, sets=sets)


def ratios(law, method, elements, repetitions, moves):
    """The median times of gradients over that of the answer: with all parameters, without laws'."""
    found = {True: [], False: []}
    for _ in range(repetitions):
        for materials in found:
            start = time.perf_counter()
            solution = body(law, elements, moves).solve(name=method)
            solved = time.perf_counter()
            u = solution.displacements if moves else solution.displacement
            solution.gradient(u, materials=materials)
            found[materials].append((time.perf_counter() - solved) / (solved - start))
    return [statistics.median(each) for each in found.values()]


def run(options):
    """Prints the table."""
    print(f"{'gradient over answer':44} {'all':>6} {'materials=False':>16}")
    for where, cases in (("at rest", AT_REST), ("in motion", IN_MOTION)):
        for title, law, method in cases:
            moves = where == "in motion"
            every, few = ratios(law, method, options.elements, options.repetitions, moves)
            print(f"{where + ', ' + title:44} {every:6.2f} {few:16.2f}", flush=True)


main = command_line(
    run,
    __doc__,
    option("--elements", type=int, default=2000, help="about; default 2000"),
    option("--repetitions", type=int, default=5, help="default 5"),
)


if __name__ == "__main__":
    sys.exit(main())
