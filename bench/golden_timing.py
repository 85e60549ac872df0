"""Time a golden: the seconds FEniCSx takes to set up, compile and solve a case with Q1-P0.

Usage: /usr/bin/python3 bench/golden_timing.py CASE.toml --mesh mesh.h5 -o out.npz [--load-steps N]
bench/time_to_rest.py starts it as a separate process, like the reference's command line.
Exit codes: 0 solved, 2 bad usage or input, 3 no equilibrium found.
"""

import argparse
import logging
import sys
import time
from pathlib import Path

import dolfinx
import numpy as np

if __name__ == "__main__":
    TREE = Path(__file__).resolve().parent.parent
    sys.path[1:1] = [str(TREE), str(TREE / "reference")]

import newton
from case_file import read_case
from common.accuracy import relative_errors
from common.command import exit_code, whole_number
from common.files import require_writable
from mesh_file import load_case_mesh
from problem import MixedProblem
from solve import LOAD_STEPS, NEWTON_TOLERANCE


class WatchedProblem(MixedProblem):
    """A MixedProblem that records when Newton's method linearizes, and at which displacement."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.moments = []

    def note(self):
        """Record the current time and displacement."""
        self.moments.append((time.perf_counter(), self.nodal_displacement()))

    def linearize(self):
        self.note()
        return super().linearize()


def seconds_within(moments, limit, unit):
    """Seconds from the first moment until the displacement stays close to the final one.

    moments: list of (seconds, displacement (n, 3) in m). limit: of max |u - u_last| over the nodes,
    as a fraction of the unit of errors, m.
    """
    started, last = moments[0][0], moments[-1][1]
    reached = moments[-1][0]
    for moment, displacement in reversed(moments):
        if relative_errors(displacement, last, unit)[0] > limit:
            break
        reached = moment
    return reached - started


def time_golden(case, mesh, load_steps):
    """Set up twice, as the first time may include compilation, and solve once.

    case: Case. mesh: HexMesh. load_steps: from rest. Returns a dict of displacement (n, 3) in m and
    of numbers: seconds (of what is in the key), load_steps, iterations, residual.
    Raises ComputationError.
    """
    set_up = [time.perf_counter()]
    for _ in range(2):
        problem = WatchedProblem(mesh, case.materials)
        set_up.append(time.perf_counter())
    first, again = np.diff(set_up)
    outcome = newton.solve(problem, load_steps, NEWTON_TOLERANCE)
    problem.note()
    unit = mesh.largest_imposed() or np.linalg.norm(problem.nodal_displacement(), axis=1).max()
    within = [seconds_within(problem.moments, limit, unit) for limit in (1e-2, 1e-3)]
    return {
        "displacement": problem.nodal_displacement(),
        "jit_seconds": first - again,
        "setup_seconds": again,
        "seconds_to_1_percent": within[0],
        "seconds_to_0_1_percent": within[1],
        "seconds_to_rest": problem.moments[-1][0] - problem.moments[0][0],
        "load_steps": outcome.load_steps,
        "iterations": outcome.newton_iterations,
        "residual": outcome.residual,
        "version": dolfinx.__version__,
    }


def run(options):
    """Reads, times, stores. Raises InputError or ComputationError."""
    logging.disable(logging.INFO)  # FFCx reports every compiler call otherwise
    case = read_case(options.case)
    mesh, _ = load_case_mesh(case, options.mesh)
    require_writable(options.output)
    np.savez(options.output, **time_golden(case, mesh, options.load_steps))


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(description="Time a golden: set-up, compilation, solution.")
    parser.add_argument("case", metavar="CASE.toml", help="the case file")
    parser.add_argument("--mesh", required=True, help="file made by `sandglass mesh CASE -o FILE`")
    parser.add_argument("-o", "--output", required=True, help="NPZ file to write")
    parser.add_argument("--load-steps", type=whole_number(1), default=LOAD_STEPS, metavar="N")
    return exit_code(run, parser.parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
