"""Code shared by the measurements of this folder: cases, the machine, times to rest, tables."""

import importlib.util
import os
import re
import sys
import types
from pathlib import Path

if importlib.util.find_spec("ufl") is None:
    # The list of laws, needed to check a case file, imports UFL. Without FEniCSx its energies are
    # never called, but the import must not fail.
    sys.modules["ufl"] = types.ModuleType("ufl")

from common.command import option, writable
from common.errors import ComputationError, InputError, suggestion
from common.files import read_toml
from common.program import CASES, binary, output_of

JSON = option("--json", type=writable, metavar="FILE", help="the records and the machine")
# The line of `sandglass run` about a static answer: evaluations, seconds.
EQUILIBRIUM = (
    r"^static equilibrium \(.*\): (\d+) evaluations?(?: and \d+ of its stability)?, (\S+) s; "
)


def rest_of(case, method, *options):
    """(evaluations, seconds) of `sandglass run`'s search for equilibrium, and its output.

    Raises InputError or ComputationError, also if the output lacks them.
    """
    text = output_of(binary(), "run", case, "-m", method, *options)
    rest = re.search(EQUILIBRIUM, text, re.MULTILINE)
    if not rest:
        raise ComputationError(
            f"sandglass run {case} -m {method}: 'static equilibrium (...): N evaluations, T s' is "
            f"required, but it printed {text!r}"
        )
    return int(rest[1]), float(rest[2]), text


def case_path(name):
    """The absolute path of a quasi-static case: a file, or the name of a case in cases/.

    Raises InputError.
    """
    places = [path for path in (Path(name), CASES / f"{name}.toml") if path.is_file()]
    if not places:
        known = suggestion(name, sorted(path.stem for path in CASES.glob("*.toml")))
        raise InputError(f"CASE: '{name}' is neither a file nor a known case; {known}")
    answer = read_toml(places[0])["case"].get("answer")
    if answer != "quasi-static":
        raise InputError(f"{places[0]}: case.answer = {answer!r} must be 'quasi-static'")
    return places[0].resolve()


def machine():
    """The machine and the program that figures were measured with, as a dict."""
    cpus = Path("/proc/cpuinfo")
    text = cpus.read_text(encoding="utf-8") if cpus.exists() else ""
    name = re.search(r"^model name\s*: (.*)$", text, re.MULTILINE)
    version = output_of(binary(), "--version").split(maxsplit=1)[-1].strip()
    return {
        "processor": name[1] if name else "unknown",
        "cores": os.cpu_count(),
        "load_average_before": os.getloadavg()[0],
        "versions": {"sandglass": version},
    }


def table(records, columns):
    """A Markdown table of records, one line each, columns aligned; "-" for None.

    columns: (heading, key, function that makes a text of the figure) of each.
    """
    rows = [[heading for heading, _, _ in columns]]
    for one in records:
        rows.append(["-" if one[key] is None else show(one[key]) for _, key, show in columns])
    widths = [max(map(len, column)) for column in zip(*rows)]
    lines = [
        "| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |"
        for row in rows
    ]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    return "\n".join(lines)
