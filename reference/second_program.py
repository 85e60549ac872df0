"""Goldens by a second program: the distances of SfePy's and GetFEM's answers from FEniCSx's.

Usage: /usr/bin/python3 reference/second_program.py [CASE...]
Recomputes the stored goldens on the same meshes, and stores the distances in
second_program.json and in the table of README.md. Needs the solver's binary, which makes the
meshes. Exit codes: 0 done, 2 bad usage or input, 3 no equilibrium found or a distance of 1e-9 or
more.
"""

import dataclasses
import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from case_file import find_case, read_case
from common.accuracy import relative_errors
from common.command import command_line, option
from common.errors import ComputationError, InputError, suggestion
from common.files import read_json, write_json, write_whole
from common.program import CASES
from mesh_file import case_with_mesh
from reference_file import path_of, read_reference, stored
from solve import load_steps_of, solve_case

STORE = Path(__file__).resolve().parent / "second_program.json"
README = Path(__file__).resolve().parent / "README.md"
BEGIN, END = "<!-- second program: begin -->", "<!-- second program: end -->"
LIMIT = 1e-9
PACKAGES = "python3-sfepy and python3-getfem (ci/setup test)"


def compared():
    """The cases whose stored goldens are compared: those without attached masses."""
    cases = ((name, find_case(CASES, name)) for name in stored("golden"))
    cases = [(name, read_case(path, name)) for name, path in cases]
    return [name for name, case in cases if not case.masses]


def distance(name, change=None):
    """The distance of a second program's answer from the golden: a record of second_program.json.

    name: of a case with a golden. change: from the Case's
    materials to others, for tests. Raises InputError or ComputationError.
    """
    case, mesh, file = case_with_mesh(find_case(CASES, name), name)
    _, reference, attributes = read_reference(path_of("golden", name))
    if (attributes["case_hash"], attributes["mesh_hash"]) != (file.case_hash, file.mesh_hash):
        raise InputError(
            f"{path_of('golden', name)}: belongs to another version of the case; run "
            f"reference/regenerate {name}"
        )
    if change:
        case = dataclasses.replace(case, materials=change(case.materials))
    problems = []

    def make(*arguments):
        problems.append(second_problem(*arguments))
        return problems[-1]

    found, _, _ = solve_case(case, mesh, 0, load_steps_of(case), make=make)
    return {
        "kind": "golden",
        "case": name,
        "elements": len(mesh.cells),
        "program": problems[-1].program,
        "distance": float(relative_errors(found[-1], reference, attributes["largest_imposed"])[0]),
    }


def second_problem(mesh, materials):
    """The problem of a HexMesh in the first of SfePy and GetFEM that supports it.

    materials: list of Material. Raises InputError if neither does.
    """
    try:
        from getfem_problem import GetfemProblem
        from sfepy_problem import SfepyProblem
    except ImportError as error:
        raise InputError(f"{error.name} is not installed; packages: {PACKAGES}") from error
    try:
        return SfepyProblem(mesh, materials)
    except InputError:
        return GetfemProblem(mesh, materials)


def table(records):
    """The Markdown table of records, as a string."""
    lines = ["| case | elements | second program | distance |", "|---|---|---|---|"]
    for record in records:
        cells = [str(record[key]) for key in ("case", "elements", "program")]
        lines.append(f"| {' | '.join(cells)} | {record['distance']:.1e} |")
    return "\n".join(lines)


def run(options):
    """Computes, prints, stores. Returns the exit code. Raises InputError."""
    known = compared()
    for name in options.cases:
        if name not in known:
            raise InputError(
                f"CASE: {name!r} has no stored golden without masses; " f"{suggestion(name, known)}"
            )
    records = {}
    if STORE.exists():
        records = {one["case"]: one for one in read_json(STORE, "this program")["records"]}
    code = 0
    for name in options.cases or known:
        try:
            record = records[name] = distance(name)
        except ComputationError as error:
            print(f"error: {name}: {error}", file=sys.stderr)
            code = 3
            continue
        says = f"{name}: {record['program']}: {record['distance']:.1e}"
        print(says, flush=True)
        if not record["distance"] < LIMIT:
            print(f"error: {says}: must be below {LIMIT:.0e}", file=sys.stderr)
            code = 3
    listed = [records[one] for one in known if one in records]
    write_json(STORE, {"records": listed})
    before, rest = README.read_text(encoding="utf-8").split(BEGIN)
    after = rest.split(END)[1]
    write_whole(README, f"{before}{BEGIN}\n{table(listed)}\n{END}{after}")
    return code


main = command_line(
    run,
    __doc__,
    option("cases", metavar="CASE", nargs="*", help="default: all that have one"),
)


if __name__ == "__main__":
    sys.exit(main())
