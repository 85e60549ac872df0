"""Error to the truth over time: meshes refined where the answer needs it, and refined as a whole.

Usage: /usr/bin/python3 bench/refinement.py [CASE...] [--json FILE] [--most N]
Times the mean-dilatation element's way to rest on a case's mesh and on that mesh with all elements
split, and `run --accuracy A --against truth`, which refines it where that element errs; one thread.
Errors are distances from the stored truth at the nodes of the case's mesh. Needs the solver:
build/release/sandglass, or the one given by SANDGLASS_BINARY.
Exit codes: 0 done, 2 bad usage or input, 3 a computation failed (the others are still shown).
"""

import re
import statistics
import sys
import tempfile
from pathlib import Path

import h5py

if __name__ == "__main__":
    TREE = Path(__file__).resolve().parent.parent
    sys.path[1:1] = [str(TREE), str(TREE / "reference")]

import measuring  # first: reference/ may then do without UFL

from case_file import find_case
from common.accuracy import relative_errors
from common.command import command_line, option, whole_number
from common.errors import ComputationError
from common.files import write_json
from common.program import CASES
from common.result_file import last_displacement
from reference_file import path_of, read_reference

METHOD = "tl-mean-dilatation"
NAMES = ("ellipsoid-indentation", "ellipsoid-touch", "column", "cylinder-compression")
ACCURACIES = (0.08, 0.04, 0.02, 0.01, 0.005, 0.0025)
ROUNDS = 3
REST, ENOUGH = 1e-8, 1e-3  # residuals: of cases, and of answers only compared with truths
WHOLE = '\n[element_sets.everything]\nx = [-inf, inf]\n\n[[refine]]\nelements = "everything"\n'


def uniform_text(text, splits, residual):
    """The text of a case file with all elements split `splits` times, and a residual to reach."""
    more = f"[relaxation]\ntolerance = {residual}\n"
    text = text.replace("[relaxation]\n", more) if "[relaxation]\n" in text else text + "\n" + more
    return text + (WHOLE + f"depth = {splits}\n" if splits else "")


def outcome_of(result, truth):
    """Elements, and the distance of the last frame from the truth, as read by read_reference()."""
    _, exact, attributes = truth
    with h5py.File(result) as file:
        elements = len(file["mesh/cells"])
    largest, rms = relative_errors(
        last_displacement(result)[: len(exact)], exact, attributes["largest_imposed"]
    )
    return {"elements": elements, "error_max": largest, "error_rms": rms}


def time_uniform(name, splits, residual, result):
    """Seconds to a residual on the mesh with all elements split this often."""
    case = result.with_name(f"{name}.toml")
    text = find_case(CASES, name).read_text(encoding="utf-8")
    case.write_text(uniform_text(text, splits, residual), encoding="utf-8")
    for _ in range(ROUNDS):
        yield measuring.rest_of(case, METHOD, "-o", result)[1]


def time_refined(name, accuracy, result):
    """Seconds to an answer on a mesh refined until it is this close to the truth."""
    options = ("-o", result, "--against", "truth", "--accuracy", accuracy)
    for _ in range(ROUNDS):
        _, on_the_mesh, text = measuring.rest_of(name, METHOD, *options)
        found = re.search(r"found in (\S+) s$", text, re.MULTILINE)
        if not found:
            raise ComputationError(f"{name}: 'found in T s' is required, not {text!r}")
        yield float(found[1]) + on_the_mesh


def ways(name, most, result):
    """(record, function that yields seconds) of each way to an answer."""
    elements = 0
    for splits in range(4):
        if splits == 0 or 8 * elements <= most:
            for residual in (REST, ENOUGH):
                known = {"way": "uniform", "splits": splits, "residual": residual}
                yield known, time_uniform(name, splits, residual, result)
            with h5py.File(result) as file:
                elements = len(file["mesh/cells"])
    for accuracy in ACCURACIES:
        yield {"way": "refined", "accuracy": accuracy}, time_refined(name, accuracy, result)


def measure_case(name, most):
    """(records, exit code) of a case. A failed way ends those of its kind."""
    truth, records = read_reference(path_of("truth", name)), []
    with tempfile.TemporaryDirectory() as folder:
        result = Path(folder) / "result.h5"
        for known, seconds in ways(name, most, result):
            try:
                middle = statistics.median(seconds)
            except ComputationError as error:
                print(f"{name}: {error}", file=sys.stderr)
                return records, 3
            record = {"case": name, **known, "seconds": middle, **outcome_of(result, truth)}
            records.append(record)
            show(record)
    return records, 0


def show(record):
    """Prints a line."""
    asked = (
        f"asked {100 * record['accuracy']:.3g} %"
        if record["way"] == "refined"
        else f"split {record['splits']} times to {record['residual']:.0e}"
    )
    print(
        f"{record['case']:<22} {record['way']:<8} {asked:<22} {record['elements']:>8} elements "
        f"{record['seconds']:8.3f} s, max {100 * record['error_max']:.3f} %, "
        f"rms {100 * record['error_rms']:.4f} %",
        flush=True,
    )


def measure(options):
    """Measures, prints, stores. Returns the exit code. Raises InputError."""
    place, records, worst = measuring.machine(), [], 0
    for name in options.cases or NAMES:
        found, code = measure_case(name, options.most)
        records += found
        worst = max(worst, code)
    if options.json:
        write_json(options.json, {**place, "records": records})
    return worst


main = command_line(
    measure,
    __doc__,
    option("cases", nargs="*", metavar="CASE", help=f"default: {', '.join(NAMES)}"),
    measuring.JSON,
    option("--most", type=whole_number(1), default=60_000, metavar="N", help="uniform elements"),
)

if __name__ == "__main__":
    sys.exit(main())
