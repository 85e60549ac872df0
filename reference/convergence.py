"""Estimates how far goldens are from their element's limit under mesh refinement.

Usage: /usr/bin/python3 reference/convergence.py [CASE...]
Solves the named cases (default: all with goldens) again on split meshes where that takes only
minutes, and stores the estimates as attributes; the stored displacements are not touched. truth.py
estimates the errors of truths in the same way, from their own meshes.
Exit codes: 0 done, 2 bad usage or input, 3 no equilibrium found.
"""

import logging
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

import solve
from case_file import find_case
from common.accuracy import relative_errors
from common.command import command_line, option
from common.errors import InputError, suggestion
from common.program import CASES
from mesh_file import case_with_mesh
from reference_file import path_of, read_reference, stored, write_estimate
from symmetry import halve

# With two meshes the order is assumed: that of the golden's element on smooth answers.
ASSUMED_ORDER = 2.0

# At an edge where a body is held or driven, displacements vary like r^a with a > 1/2, so energy,
# and with it the displacement of loads, converges with order 2 a > 1. A sequence that seems slower
# has not reached its asymptotic order; extrapolating with the measured one would go too far.
LOWEST_ORDER = 1.0

# A golden's mesh, halved at its mirror planes, is split as long as that gives at most this many
# cells: about a minute on one core.
MOST_CELLS = 18000
MOST_SPLITS = 3


@dataclass(frozen=True)
class Estimate:
    """The limit of a sequence of fields and how it was found.

    limit: (n, 3). order: order of convergence used. origin: "measured", "assumed", or "the lowest"
    if the measured order was lower than LOWEST_ORDER.
    """

    limit: np.ndarray
    order: float
    origin: str


def richardson(fields, assumed_order):
    """The limit of fields on meshes of edge h, h/2, h/4, ... by Richardson's extrapolation.

    fields: two or more arrays (n, 3), coarse to fine, at the same points. If the error is C h^p,
    the differences of successive fields fall by 2^p, and the error of the last field is the last
    difference over 2^p - 1. With three or more fields, p follows from the root mean square
    differences of the last three, but is at least LOWEST_ORDER; with two it is assumed_order.
    Returns an Estimate, or None for fewer than two fields or if the differences do not fall.
    """
    if len(fields) < 2:
        return None
    last = fields[-1] - fields[-2]
    order, origin = assumed_order, "assumed"
    if len(fields) > 2:
        before, after = (np.linalg.norm(d) for d in (fields[-2] - fields[-3], last))
        if not before > after > 0:
            return None
        order, origin = math.log2(before / after), "measured"
        if order < LOWEST_ORDER:
            order, origin = LOWEST_ORDER, f"the lowest, measured {order:.2f}"
    return Estimate(fields[-1] + last / (2**order - 1), order, origin)


def attributes_of(fields, displacement, unit, reason, assumed_order=ASSUMED_ORDER):
    """The attributes that state how far a displacement is from the limit of `fields`.

    fields, assumed_order: as for richardson(). displacement: (n, 3), m, one of the fields. unit: m,
    for relative errors. reason: why there are no more fields, for the note. Returns what
    reference_file.write_estimate() takes.
    """
    estimate = richardson(fields, assumed_order)
    if estimate is None:
        why = "differences do not fall" if len(fields) > 1 else reason
        errors, order, note = (math.nan, math.nan), math.nan, f"not estimated: {why}"
    else:
        errors = relative_errors(displacement, estimate.limit, unit)
        order = estimate.order
        note = f"Richardson's extrapolation of {len(fields)} meshes; order {order:.2f}: "
        note += estimate.origin + (f", for {reason}" if estimate.origin == "assumed" else "")
    return {
        "own_error_max": errors[0],
        "own_error_rms": errors[1],
        "own_error_order": order,
        "own_error_note": note,
    }


def splits_of(cells):
    """The number of times that a golden's mesh with this many cells is split for an estimate."""
    splits = 0
    while splits < MOST_SPLITS and cells * 8 ** (splits + 1) <= MOST_CELLS:
        splits += 1
    return splits


def fields_of(name, displacement):
    """The displacements of the golden's element on its mesh split 0, 1, 2, ... times.

    displacement: the stored one, on the mesh itself. Returns (list of (n, 3), m; why there are no
    more). Raises InputError or ComputationError.
    """
    case, mesh, _ = case_with_mesh(find_case(CASES, name), name)
    if mesh.ties:
        return [displacement], "a mesh with hanging nodes is not split further"
    cells = len(halve(mesh)[0].cells)
    splits = splits_of(cells)
    reason = f"a mesh of {cells * 8 ** (splits + 1)} cells would cost too much"
    fields, _, _ = solve.solve_case(case, mesh, splits, solve.load_steps_of(case))
    return [displacement] + fields[1:], reason


def estimate(name):
    """Estimate a golden's own error and store it. Raises InputError or ComputationError."""
    path = path_of("golden", name)
    _, displacement, attributes = read_reference(path)
    fields, reason = fields_of(name, displacement)
    found = attributes_of(fields, displacement, attributes["largest_imposed"], reason)
    print(f"{name}: {100 * found['own_error_max']:.3g} %; {found['own_error_note']}")
    write_estimate(path, found)


def run(options):
    """Estimates the errors of the named goldens. Raises InputError or ComputationError."""
    logging.disable(logging.INFO)  # FFCx reports every compiler call otherwise
    known = stored("golden")
    for name in options.cases or known:
        if name not in known:
            raise InputError(f"CASE: '{name}' has no golden; {suggestion(name, known)}")
        estimate(name)


main = command_line(
    run,
    __doc__,
    option("cases", nargs="*", metavar="CASE", help="default: all stored ones"),
)


if __name__ == "__main__":
    sys.exit(main())
