"""Error against cost of static contact, over methods, meshes and the penalty.

Usage: /usr/bin/python3 bench/contact_cost.py [--json FILE] [--meshes N...]
Solves cases/hertz.toml, a ball pressed into a block, with every method that resists hourglass
modes, on meshes of N x N x N elements with refinements, which have N elements across the contact,
and with tl-perturbation also for several penalties. Errors are those of the force against Hertz's
closed form. The cost is evaluations to static equilibrium times operations of the elements' forces,
as `sandglass flops` counts them: it depends on no machine. Needs the solver:
build/release/sandglass, or the one given by SANDGLASS_BINARY.
Exit codes: 0 done, 2 bad usage or input.
"""

import sys
import tempfile
from pathlib import Path

import h5py

if __name__ == "__main__":
    TREE = Path(__file__).resolve().parent.parent
    sys.path[1:1] = [str(TREE), str(TREE / "reference")]

import measuring

from common.command import command_line, option, whole_number
from common.errors import ComputationError, InputError
from common.files import read_json, write_json
from common.program import CASES, binary, output_of

FORCE = 500.0  # N, of a quarter: 1/3 E* sqrt(R d^3), E* = 1.5e7 Pa, R = 10 m, d = 1 mm
MESHES = (4, 6, 8)
PENALTIES = (0.1, 0.3, 1, 3, 10, 30, 100, 300, 1000)
NO_CONTROL = ("tl-none", "ul-viscous")  # hourglass modes are not resisted at rest
OF_PENALTIES = "tl-perturbation"


def case_text(elements, penalty=None):
    """The text of the case with N elements along each edge of the block, and a penalty or none."""
    text = (CASES / "hertz.toml").read_text(encoding="utf-8").split("[[expect]]")[0]
    text = text.replace('generator = "box"\n', f'generator = "box"\nelements = {[elements] * 3}\n')
    if penalty is not None:
        text = text.replace("[[obstacle]]\n", f"[[obstacle]]\npenalty = {float(penalty)}\n")
    return text + f'[[refine]]\naround = "centre"\ndepth = 6\nlayers = {max(1, elements // 2)}\n'


def operations(folder):
    """Method -> operations of the force of an element, with the law of the case."""
    file = Path(folder) / "flops.json"
    output_of(binary(), "flops", "--json", file)
    whole = {"law": "neo-hookean", "form": "kernel", "part": "element"}
    records = read_json(file, "sandglass flops --json")["records"]
    return {one["method"]: one["total"] for one in records if whole.items() <= one.items()}


def solved(folder, method, elements, penalty=None):
    """Evaluations, number of elements and error of the force of an answer."""
    case, result = Path(folder) / "hertz.toml", Path(folder) / "hertz.h5"
    case.write_text(case_text(elements, penalty), encoding="utf-8")
    evaluations, _, _ = measuring.rest_of(case, method, "-o", result)
    with h5py.File(result) as file:
        force = -file["history/reaction/ball"][-1][2]
        return evaluations, len(file["mesh/cells"]), abs(force / FORCE - 1)


def study(meshes):
    """Yields records: method, across, penalty (None: the default), elements, operations, error.

    The last three are None if the method finds no answer.
    """
    with tempfile.TemporaryDirectory() as folder:
        of_element = operations(folder)
        methods = [method for method in of_element if method not in NO_CONTROL]
        runs = [(method, across, None) for across in meshes for method in methods]
        runs += [(OF_PENALTIES, across, penalty) for across in meshes for penalty in PENALTIES]
        for method, across, penalty in runs:
            found = {"method": method, "across": across, "penalty": penalty}
            try:
                evaluations, elements, error = solved(folder, method, across, penalty)
                work = evaluations * elements * of_element[method]
            except (ComputationError, InputError) as failure:
                print(f"{method}, {across}: {str(failure).splitlines()[0]}", file=sys.stderr)
                elements = work = error = None
            yield found | {"elements": elements, "operations": work, "error": error}


def run(options):
    """Prints a line for each record, and writes them. Raises InputError."""
    records = []
    for found in study(options.meshes or MESHES):
        records.append(found)
        penalty = "" if found["penalty"] is None else f" penalty {found['penalty']:g}"
        answer = "no answer"
        if found["error"] is not None:
            answer = f"{found['operations'] / 1e9:.3f} Gflop, {100 * found['error']:.3f} %"
        print(f"{found['method']}{penalty}, {found['across']} across: {answer}", flush=True)
    if options.json:
        write_json(options.json, {"case": "hertz", "records": records})


main = command_line(
    run,
    __doc__,
    option("--json", metavar="FILE", type=Path, help="where to store the records"),
    option("--meshes", metavar="N", nargs="+", type=whole_number(2), help="default: 4 6 8"),
)

if __name__ == "__main__":
    sys.exit(main())
