"""Records of what a program took to bring a case to rest: reading, checking, showing, storing.

A record is a dict with every key of KEYS; None stands for what is not measured.
"""

import argparse
import json
import math
import os
import re
import tempfile
from pathlib import Path

from errors import DivergenceError, InputError

# What `sandglass bench --rest` gives of each of its runs.
SOLVER_KEYS = {
    "case": str,
    "method": str,
    "precision": str,
    "steps": int,
    "seconds_to_1_percent": float,
    "seconds_to_0_1_percent": float,
    "seconds_to_rest": float,
    "residual": float,
}
# What else this benchmark knows. steps: of an implicit program, its load steps.
KEYS = {
    "program": str,
    **SOLVER_KEYS,
    "iterations": int,
    "setup_seconds": float,
    "jit_seconds": float,
    "process_seconds": float,
    "error_to_golden_max": float,
    "error_to_golden_rms": float,
}
REQUIRED = ("case", "method", "precision")


def record(**known):
    """A record with these figures, None for all others. Raises KeyError for an unknown key."""
    for key in known:
        KEYS[key]
    return {key: known.get(key) for key in KEYS}


def read_solver_records(path):
    """The records of the document that `sandglass bench --rest` wrote: objects with SOLVER_KEYS.

    Other keys, of the document and of a record, are ignored. Returns a list of records with
    program "sandglass". Raises InputError naming file, entry, key, value and rule.
    """
    try:
        document = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot read the records: {error.strerror}") from error
    except ValueError as error:
        raise InputError(f"{path}: not a JSON file: {error}") from error
    if not isinstance(document, dict):
        raise InputError(f"{path}: an object is required, not {type(document).__name__}")
    entries = document.get("records")
    if not isinstance(entries, list):
        raise InputError(f"{path}: records = {entries!r}: a list is required")
    return [_checked(path, number, entry) for number, entry in enumerate(entries)]


def _checked(path, number, entry):
    """One entry of a list of solver records as a record. Raises InputError."""
    if not isinstance(entry, dict):
        raise InputError(f"{path}: record {number} = {entry!r}: an object is required")
    for key, kind in SOLVER_KEYS.items():
        if key not in entry:
            raise InputError(f"{path}: record {number}: {key} is missing")
        value = entry[key]
        if value is None and key not in REQUIRED:
            continue
        number_wanted = kind is not str
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if number_wanted and not (is_number and math.isfinite(value) and value >= 0):
            raise InputError(
                f"{path}: record {number}: {key} = {value!r}: a number >= 0 or null is required"
            )
        if not number_wanted and not isinstance(value, str):
            raise InputError(f"{path}: record {number}: {key} = {value!r}: a text is required")
    return record(program="sandglass", **{key: entry[key] for key in SOLVER_KEYS})


def read_run(case, method, text):
    """The record of what `sandglass run` printed about a quasi-static case: only time to rest.

    Raises DivergenceError when the text does not say that the case came to rest, and how fast.
    """
    rest = re.search(r"at rest after (\d+) steps, residual (\S+)", text)
    wall = re.search(r"^wall time (\S+) s", text, re.MULTILINE)
    if not (rest and wall):
        raise DivergenceError(
            f"sandglass run {case} -m {method}: 'at rest after N steps, residual R' and 'wall time "
            f"T s' are required, but it printed {text!r}"
        )
    return record(
        program="sandglass",
        case=case,
        method=method,
        precision="double",
        steps=int(rest[1]),
        seconds_to_rest=float(wall[1]),
        residual=float(rest[2]),
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
    ("steps", "steps", str),
    ("iterations", "iterations", str),
    ("to golden, max", "error_to_golden_max", lambda fraction: f"{100 * fraction:.3g} %"),
    ("rms", "error_to_golden_rms", lambda fraction: f"{100 * fraction:.3g} %"),
)


def table(records, columns=COLUMNS):
    """A Markdown table of records, one line each, columns aligned; "-" for None.

    columns: (heading, key, function that makes a text of the figure) of each.
    """
    rows = [[heading for heading, _, _ in columns]]
    for entry in records:
        rows.append(["-" if entry[key] is None else show(entry[key]) for _, key, show in columns])
    widths = [max(map(len, column)) for column in zip(*rows)]
    lines = [
        "| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |"
        for row in rows
    ]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    return "\n".join(lines)


def write_json(path, document):
    """Write a document to a temporary file beside `path` and rename it. Raises InputError."""
    path = Path(path).resolve()
    temporary = None
    try:
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            json.dump(document, file, indent=2, allow_nan=False)
            file.write("\n")
        os.chmod(temporary, 0o644)  # mkstemp makes it readable by its owner only
        os.replace(temporary, path)
    except OSError as error:
        raise InputError(f"{path}: cannot write: {error.strerror}") from error
    finally:
        if temporary and os.path.exists(temporary):
            os.unlink(temporary)


def whole_number(smallest):
    """A function that takes a whole number >= smallest out of the command line, for argparse."""

    def number(text):
        found = int(text)
        if found < smallest:
            raise argparse.ArgumentTypeError(f"{text}: must be {smallest} or more")
        return found

    return number
