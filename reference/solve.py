"""Solve a case with mixed elements in FEniCSx: the golden (Q1-P0) or the truth (Q2-P1).

Usage: /usr/bin/python3 reference/solve.py golden|truth CASE.toml --mesh mesh.h5 -o out.h5
Exit codes: 0 solved, 2 bad usage or input, 3 no equilibrium found.
"""

import argparse
import logging
import math
import sys
import time
from dataclasses import replace

import dolfinx
import numpy as np

import newton
from accuracy import relative_errors
from case_file import read_case
from errors import DivergenceError, InputError
from hexahedra import refine
from mesh_file import load_case_mesh
from problem import GOLDEN, TRUTH, MixedProblem
from result_file import NOT_ESTIMATED, require_writable, write_result
from symmetry import halve

PAIRS = {"golden": GOLDEN, "truth": TRUTH}
# A step that fails is halved, so these only set the speed. A body cannot be turned far in one step.
LOAD_STEPS = {"golden": 10, "truth": 1}
LARGEST_TURN = math.radians(36)
NEWTON_TOLERANCE = 1e-10
BOUNDARY_RULE = "trace of Q1: every vertex, edge and face whose vertices are all prescribed"


def solve_case(kind, case, mesh, refinements, load_steps, pair=None):
    """Solve a case on its mesh and on that mesh split once, twice, ... `refinements` times.

    kind: "golden" or "truth". case: Case. mesh: HexMesh. load_steps: from rest, on the first mesh.
    pair: ElementPair, that of the kind unless told.
    Returns (list of displacements (n, 3) in m at the nodes of the mesh, one per mesh; Outcome on
    the last mesh; axes of the mirror planes used, as text). Raises DivergenceError.
    """
    # The golden is the oracle of every other program: on its own mesh it takes no short cut.
    part, halves = halve(mesh) if kind == "truth" or refinements else (mesh, [])
    n_nodes = len(part.points)
    displacements, coarse = [], None
    for level in range(refinements + 1):
        part = refine(part) if level else part
        problem = MixedProblem(part, pair or PAIRS[kind], case.law, case.material)
        if coarse:
            problem.start_from(coarse)
        outcome = newton.solve(problem, load_steps, NEWTON_TOLERANCE, guessed=bool(coarse))
        whole = problem.nodal_displacement()[:n_nodes]
        for half in reversed(halves):
            whole = half.expand(whole)
        displacements.append(whole)
        coarse = problem
    return displacements, outcome, "".join("xyz"[half.axis] for half in halves)


def load_steps_of(kind, case):
    """Into how many steps the load of a Case is split at first."""
    turn = max((abs(rotation.angle) for rotation in case.rotations), default=0.0)
    return max(LOAD_STEPS[kind], math.ceil(turn / LARGEST_TURN - 1e-9))


def run(arguments):
    """Read, solve, store. Raises InputError or DivergenceError."""
    started = time.perf_counter()
    kind, refinements = arguments.kind, arguments.refine
    case = read_case(arguments.case, arguments.variant)
    mesh, file = load_case_mesh(case, arguments.mesh)
    require_writable(arguments.output)
    pair = replace(PAIRS[kind], gauss_points=arguments.gauss or PAIRS[kind].gauss_points)
    load_steps = arguments.load_steps or load_steps_of(kind, case)
    displacements, outcome, mirrors = solve_case(kind, case, mesh, refinements, load_steps, pair)
    unit = mesh.largest_imposed() or np.linalg.norm(displacements[-1], axis=1).max()
    errors, note = (math.nan, math.nan), "not estimated"
    if refinements:
        errors = relative_errors(displacements[-2], displacements[-1], unit)
        note = f"difference to the same element on the mesh split {refinements - 1} times"
    write_result(
        arguments.output,
        mesh.points,
        displacements[-1],
        {
            "case": case.name,
            "case_hash": file.case_hash,
            "mesh_hash": file.mesh_hash,
            "kind": kind,
            "element": pair.name,
            "refinements": refinements,
            "quadrature": pair.quadrature,
            "law": case.law,
            "mirror_planes": mirrors,
            "boundary_rule": BOUNDARY_RULE,
            "largest_imposed": unit,
            "load_steps": outcome.load_steps,
            "newton_iterations": outcome.newton_iterations,
            "residual": outcome.residual,
            "newton_tolerance": NEWTON_TOLERANCE,
            "last_correction": outcome.last_increment,
            "dolfinx_version": dolfinx.__version__,
            "wall_seconds": time.perf_counter() - started,
            "discretisation_error_max": errors[0],
            "discretisation_error_rms": errors[1],
            "discretisation_error_note": note,
            **NOT_ESTIMATED,
        },
    )


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(
        description="Solve a case with mixed elements in FEniCSx.",
        epilog="exit codes: 0 solved, 2 bad usage or input, 3 no equilibrium found",
    )
    parser.add_argument("kind", choices=PAIRS, help="golden: Q1-P0; truth: Q2-P1")
    parser.add_argument("case", metavar="CASE.toml", help="the case file")
    parser.add_argument("--variant", metavar="NAME", help="case of the file, where it has variants")
    parser.add_argument("--mesh", required=True, help="file made by `sandglass mesh CASE -o FILE`")
    parser.add_argument("-o", "--output", required=True, help="HDF5 file to write")
    parser.add_argument(
        "--refine",
        type=_count,
        default=0,
        metavar="N",
        help="split every hexahedron into 8, N times; the difference to N-1 is stored as the "
        "estimate of the discretisation error (default 0: no estimate)",
    )
    parser.add_argument(
        "--load-steps", type=_count, metavar="N", help=f"default: {LOAD_STEPS}, halved on failure"
    )
    parser.add_argument(
        "--gauss", type=_count, metavar="N", help="Gauss points per direction; default: 2 and 4"
    )
    parsed = parser.parse_args(arguments)
    logging.disable(logging.INFO)  # FFCx reports every compiler call otherwise
    try:
        run(parsed)
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except DivergenceError as error:
        print(f"error: {parsed.case}: {error}", file=sys.stderr)
        return 3
    return 0


def _count(text):
    """A whole number >= 0 out of the command line."""
    number = int(text)
    if number < 0:
        raise argparse.ArgumentTypeError(f"{text}: must be 0 or more")
    return number


if __name__ == "__main__":
    sys.exit(main())
