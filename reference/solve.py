"""Solve a case with mixed elements (Q1-P0) in FEniCSx: its golden, quasi-static or of motion.

Usage: /usr/bin/python3 reference/solve.py golden|motion CASE.toml --mesh mesh.h5 -o out.h5
Exit codes: 0 solved, 2 bad usage or input, 3 no equilibrium or motion found.
"""

import dataclasses
import logging
import math
import sys
import time
from pathlib import Path

import dolfinx
import numpy as np

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

import motion
import newton
from case_file import read_case
from common.accuracy import relative_errors
from common.command import command_line, option, whole_number, writable
from common.errors import ComputationError, InputError
from hexahedra import refine
from mesh_file import initial_velocity, load_case_mesh
from problem import MixedProblem
from reference_file import MOTION, NOT_ESTIMATED, write_reference
from symmetry import expand, halve, part_bodies
from tied_problem import TiedProblem

KINDS = ("golden", MOTION)
# A step that fails is halved, so these affect only the speed. One step cannot turn a body far.
LOAD_STEPS = 10
LARGEST_TURN = math.radians(36)
NEWTON_TOLERANCE = 1e-10
BOUNDARY_RULE = "trace of Q1: every vertex, edge and face whose vertices are all prescribed"


def solve_case(case, mesh, refinements, load_steps, make=MixedProblem):
    """Solve a case on its mesh and on that mesh split once, twice, ... `refinements` times.

    case: Case. mesh: HexMesh. load_steps: on the first mesh. make: from HexMesh and materials to a
    problem for newton.solve(). Returns (list of displacements (n, 3) in m at the nodes of the mesh,
    one per mesh; Outcome on the last mesh; axes of the mirror planes used, as text). Raises
    ComputationError.
    """
    # The golden is the oracle for everything else, so it takes no short cut on its own mesh.
    part, halves = halve(mesh) if refinements else part_bodies(mesh)
    n_nodes = len(part.points)
    displacements, coarse = [], None
    for level in range(refinements + 1):
        part = refine(part) if level else part
        problem = make(part, case.materials)
        if part.ties:
            problem = TiedProblem(problem, part.ties)
        if coarse:
            problem.start_from(coarse)
        try:
            outcome = newton.solve(problem, load_steps, NEWTON_TOLERANCE, guessed=bool(coarse))
        except ComputationError as error:
            raise ComputationError(f"{case.name}: {error}") from error
        displacements.append(expand(halves, problem.nodal_displacement()[:n_nodes]))
        coarse = problem
    return displacements, outcome, "".join("xyz"[half.axis] for half in halves)


def load_steps_of(case):
    """The initial number of load steps of a Case."""
    turn = max((abs(rotation.angle) for rotation in case.rotations), default=0.0)
    return max(LOAD_STEPS, math.ceil(turn / LARGEST_TURN - 1e-9))


def run(options):
    """Reads, solves, stores. Raises InputError or ComputationError."""
    started = time.perf_counter()
    kind, refinements = options.kind, options.refine
    case = read_case(options.case, options.variant)
    if (kind == MOTION) != bool(case.motion):
        raise InputError(f"{options.case}: a dynamic case has a golden of motion and no other")
    if options.penalty:
        soft = (dataclasses.replace(one, limit=False) for one in case.obstacles)
        case = dataclasses.replace(case, obstacles=tuple(soft))
    mesh, file = load_case_mesh(case, options.mesh)
    if mesh.ties and (kind != "golden" or refinements):
        raise InputError(
            f"{options.case}: a refined mesh has only a quasi-static golden: motion and "
            "meshes that are split further have no ties here"
        )
    logging.disable(logging.INFO)  # FFCx reports every compiler call otherwise
    if case.motion:
        velocity = initial_velocity(case, options.mesh)
        golden = motion.solve_motion(mesh, case.materials, case.motion, velocity)
        displacement, unit, outcome, mirrors = golden.displacement, golden.unit, golden.outcome, ""
        halving = {"halving_max": golden.halving[0], "halving_rms": golden.halving[1]}
        facts = halving | discretisation_error([], unit)
    else:
        load_steps = options.load_steps or load_steps_of(case)
        displacements, outcome, mirrors = solve_case(case, mesh, refinements, load_steps)
        displacement = displacements[-1]
        unit = mesh.largest_imposed() or np.linalg.norm(displacement, axis=1).max()
        facts = discretisation_error(displacements, unit)
    attributes = origin(case, file, kind, started) | {
        "element": "Q1-P0",
        "refinements": refinements,
        "quadrature": "Gauss-Legendre 2x2x2",
        "mirror_planes": mirrors,
        "largest_imposed": unit,
        "load_steps": outcome.load_steps,
        "newton_iterations": outcome.newton_iterations,
        "residual": outcome.residual,
        "newton_tolerance": motion.TOLERANCE if case.motion else NEWTON_TOLERANCE,
        "last_correction": outcome.last_correction,
        **facts,
        **NOT_ESTIMATED,
    }
    times = case.motion.times() if case.motion else None
    write_reference(options.output, mesh.points, displacement, attributes, times)


def origin(case, file, kind, started):
    """The attributes that every reference has: of its case and mesh, and when it was started."""
    hashes = {name: getattr(file, name) for name in ("case_hash", "mesh_hash")}
    laws = ", ".join(material.law for material in case.materials)
    known = {"case": case.name, "kind": kind, "law": laws, "boundary_rule": BOUNDARY_RULE}
    known |= {"dolfinx_version": dolfinx.__version__}
    return hashes | known | {"wall_seconds": time.perf_counter() - started}


def discretisation_error(displacements, unit):
    """The attributes that state how far the last displacements are from the previous ones.

    displacements: from solve_case(). unit: m, for relative errors.
    """
    errors, note = (math.nan, math.nan), "not estimated"
    if len(displacements) > 1:
        errors = relative_errors(displacements[-2], displacements[-1], unit)
        note = f"difference to the same element on the mesh split {len(displacements) - 2} times"
    return {
        "discretisation_error_max": errors[0],
        "discretisation_error_rms": errors[1],
        "discretisation_error_note": note,
    }


main = command_line(
    run,
    __doc__,
    option("kind", choices=KINDS, help="golden: of a quasi-static case; motion: of a dynamic case"),
    option("case", metavar="CASE.toml", help="the case file"),
    option("--variant", metavar="NAME", help="case of the file, if it has variants"),
    option("--mesh", required=True, help="file made by `sandglass mesh CASE -o FILE`"),
    option("-o", "--output", type=writable, required=True, help="HDF5 file to write"),
    option(
        "--refine",
        type=whole_number(0),
        default=0,
        metavar="N",
        help="split every hexahedron into 8, N times; the difference to N-1 is stored as the "
        "estimate of the discretisation error (default 0: no estimate)",
    ),
    option(
        "--penalty",
        action="store_true",
        help="obstacles give way by their penalty (default: nothing penetrates them)",
    ),
    option(
        "--load-steps",
        type=whole_number(1),
        metavar="N",
        help=f"default: {LOAD_STEPS}, halved on failure",
    ),
)


if __name__ == "__main__":
    sys.exit(main())
