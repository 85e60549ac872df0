"""The goldens by a second program: how far SfePy's own elements are from FEniCSx's answers.

Usage: /usr/bin/python3 reference/second_golden.py [CASE...]
Computes the stored goldens once more on the same meshes, from rest, and stores the distances in
second_golden.json and in the table of README.md. Needs the solver's binary, which makes the meshes.
Exit codes: 0 done, 2 bad usage or input, 3 no equilibrium found or a distance of 1e-9 or more.
"""

import argparse
import sys
import tempfile
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

import newton
from case_file import find_case, read_case
from common.accuracy import relative_errors
from common.command import exit_code
from common.errors import ComputationError, InputError, suggestion
from common.files import read_json, write_json, write_whole
from common.program import CASES
from mesh_file import load_case_mesh, make_mesh
from reference_file import path_of, read_reference, stored
from solve import NEWTON_TOLERANCE, load_steps_of

STORE = Path(__file__).resolve().parent / "second_golden.json"
README = Path(__file__).resolve().parent / "README.md"
BEGIN, END = "<!-- second golden: begin -->", "<!-- second golden: end -->"
LIMIT = 1e-9
PACKAGE = "python3-sfepy (ci/setup test)"


def distance(name, change=None):
    """How far SfePy's answer is from the stored golden: a record, as in second_golden.json.

    name: of a case with a golden. change: from the Case's materials to others, for tests.
    What SfePy cannot say is a reason instead of a distance. Raises InputError or ComputationError.
    """
    try:
        from sfepy_problem import VERSION, SfepyProblem
    except ImportError as error:
        raise InputError(f"{error.name} is not installed; it needs package {PACKAGE}") from error
    path = find_case(CASES, name)
    case = read_case(path, name)
    with tempfile.TemporaryDirectory() as folder:
        make_mesh(path, Path(folder) / "mesh.h5", name)
        mesh, file = load_case_mesh(case, Path(folder) / "mesh.h5")
    _, golden, attributes = read_reference(path_of("golden", name))
    if (attributes["case_hash"], attributes["mesh_hash"]) != (file.case_hash, file.mesh_hash):
        raise InputError(
            f"{path_of('golden', name)}: belongs to another version of the case; run "
            f"reference/regenerate {name}"
        )
    record = {"case": name, "elements": len(mesh.cells), "program": f"SfePy {VERSION}"}
    try:
        problem = SfepyProblem(mesh, change(case.materials) if change else case.materials)
    except InputError as reason:
        return record | {"reason": str(reason)}
    newton.solve(problem, load_steps_of("golden", case), NEWTON_TOLERANCE)
    errors = relative_errors(problem.nodal_displacement(), golden, attributes["largest_imposed"])
    return record | {"distance": float(errors[0])}


def table(records):
    """The Markdown table of records, as a string."""
    lines = ["| case | elements | golden to SfePy's answer, max |", "|---|---|---|"]
    for record in records:
        says = f"{record['distance']:.1e}" if "distance" in record else record["reason"]
        lines.append(f"| {record['case']} | {record['elements']} | {says} |")
    return "\n".join(lines)


def run(options):
    """Computes, prints, stores. Returns the exit code. Raises InputError."""
    known = stored("golden")
    for name in options.cases:
        if name not in known:
            raise InputError(f"CASE: {name!r} has no stored golden; {suggestion(name, known)}")
    records = {}
    if STORE.exists():
        records = {one["case"]: one for one in read_json(STORE, "this program")["records"]}
    code = 0
    for name in options.cases or known:
        try:
            records[name] = distance(name)
        except ComputationError as error:
            print(f"error: {name}: {error}", file=sys.stderr)
            code = 3
            continue
        found = records[name].get("distance")
        print(f"{name}: {records[name].get('reason') or f'{found:.1e}'}", flush=True)
        if found is not None and not found < LIMIT:
            print(f"error: {name}: {found:.1e} must be below {LIMIT:.0e}", file=sys.stderr)
            code = 3
    listed = [records[name] for name in known if name in records]
    write_json(STORE, {"records": listed})
    before, rest = README.read_text(encoding="utf-8").split(BEGIN)
    after = rest.split(END)[1]
    write_whole(README, f"{before}{BEGIN}\n{table(listed)}\n{END}{after}")
    return code


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(
        description="Compute the goldens by a second program, SfePy.",
        epilog="exit codes: 0 done, 2 bad usage or input, 3 no equilibrium or too far",
    )
    parser.add_argument("cases", metavar="CASE", nargs="*", help="default: all with a golden")
    return exit_code(run, parser.parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
