"""Records of a program's time to rest: reading, checking, printing, storing.

A record is a dict with every key of KEYS; None means not measured.
"""

import re

from common.errors import ComputationError, InputError
from common.files import read_json
from common.records import NUMBER, entries, entry

# Keys written by `sandglass bench --rest` for each of its runs.
SOLVER_KEYS = {
    "case": str,
    "method": str,
    "precision": str,
    "evaluations": int,
    "seconds_to_1_percent": float,
    "seconds_to_0_1_percent": float,
    "seconds_to_rest": float,
    "residual": float,
}
# Keys added by this benchmark. load_steps, iterations: of an implicit program.
KEYS = {
    "program": str,
    **SOLVER_KEYS,
    "load_steps": int,
    "iterations": int,
    "setup_seconds": float,
    "jit_seconds": float,
    "process_seconds": float,
    "error_to_golden_max": float,
    "error_to_golden_rms": float,
}


def record(**known):
    """A record with these figures, None for all others. Raises KeyError for an unknown key."""
    for key in known:
        KEYS[key]
    return {key: known.get(key) for key in KEYS}


def read_solver_records(path):
    """The records in a document of `sandglass bench --rest`: objects with SOLVER_KEYS.

    Other keys, of the document and of a record, are ignored. Returns a list of records with
    program "sandglass". Raises InputError naming file, entry, key, value and rule.
    """
    return [_checked(*found) for found in entries(path, read_json(path), "records")]


def _checked(where, found):
    """One solver record as a record: texts, and numbers >= 0 or null."""
    figures = {}
    for key, kind in SOLVER_KEYS.items():
        text = kind is str
        figures[key] = entry(where, found, key, str if text else NUMBER, none_allowed=not text)
        if not text and figures[key] is not None and figures[key] < 0:
            raise InputError(f"{where}.{key} = {figures[key]!r} must be >= 0 or null")
    return record(program="sandglass", **figures)


# What `sandglass run` prints of a body at rest: evaluations, seconds, residual.
EQUILIBRIUM = (
    r"^static equilibrium \(.*\): (\d+) evaluations?(?: and \d+ of its stability)?, (\S+) s; "
    r"residual ([\d.e+-]+)"
)


def read_run(case, method, text):
    """The record (time to rest only) from the output of `sandglass run` on a quasi-static case.

    Raises ComputationError if the text does not state that the case came to rest, and its time.
    """
    rest = re.search(EQUILIBRIUM, text, re.MULTILINE)
    if not rest:
        raise ComputationError(
            f"sandglass run {case} -m {method}: 'static equilibrium (...): N evaluations, T s; "
            f"residual R' is required, but it printed {text!r}"
        )
    return record(
        program="sandglass",
        case=case,
        method=method,
        precision="double",
        evaluations=int(rest[1]),
        seconds_to_rest=float(rest[2]),
        residual=float(rest[3]),
    )


# Heading, key, format of a figure.
COLUMNS = (
    ("program", "program", str),
    ("method", "method", str),
    ("number", "precision", str),
    ("to 1 %, s", "seconds_to_1_percent", "{:.3g}".format),
    ("to 0.1 %, s", "seconds_to_0_1_percent", "{:.3g}".format),
    ("to rest, s", "seconds_to_rest", "{:.3g}".format),
    ("residual", "residual", "{:.1e}".format),
    ("set-up, s", "setup_seconds", "{:.3g}".format),
    ("compiling, s", "jit_seconds", "{:.3g}".format),
    ("process, s", "process_seconds", "{:.3g}".format),
    ("evaluations", "evaluations", str),
    ("load steps", "load_steps", str),
    ("iterations", "iterations", str),
    ("to golden, max", "error_to_golden_max", lambda fraction: f"{100 * fraction:.3g} %"),
    ("rms", "error_to_golden_rms", lambda fraction: f"{100 * fraction:.3g} %"),
)


def table(records, columns=COLUMNS):
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
