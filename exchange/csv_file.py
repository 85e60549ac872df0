"""Reads displacements from a table of comma-separated values with named columns."""

import csv
import math

import numpy as np

from common.errors import InputError

# Accepted names of a column, in lower case; those with a digit are ParaView's.
POINTS = {axis: (axis, f"points:{i}", f"points_{i}") for i, axis in enumerate("xyz")}
RULE = "columns id or x, y, z, and ux, uy, uz are required (or ParaView's Points:0, displacement:0)"


def read(path, field):
    """(points (n, 3) or None, ids (n,) or None, displacement (n, 3)), m; one of the two is given.

    field: name of the displacement columns NAME:0, NAME:1, NAME:2, or None for ux, uy, uz or
    displacement:0 .... Raises InputError naming the line and the rule.
    """
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            rows = [(reader.line_num, row) for reader in [csv.reader(file)] for row in reader]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: cannot be read as a table: {error}") from error
    rows = [(line, [cell.strip() for cell in row]) for line, row in rows if "".join(row).strip()]
    if len(rows) < 2:
        raise InputError(f"{path}: has no rows below the column names; {RULE}")
    header = [name.lower() for name in rows[0][1]]
    twice = {name for name in header if header.count(name) > 1}
    if twice:
        raise InputError(f"{path}:1: column '{min(twice)}' occurs twice; names must differ")
    name = (field or "displacement").lower()
    spelled = [
        [] if field else ["ux", "uy", "uz"],
        [f"{name}:{i}" for i in range(3)],
        [f"{name}_{i}" for i in range(3)],
    ]
    motion = next((columns for columns in spelled if columns and set(columns) <= set(header)), None)
    at = [next((n for n in POINTS[axis] if n in header), None) for axis in "xyz"]
    if motion is None or (None in at and "id" not in header):
        raise InputError(f"{path}:1: columns {', '.join(rows[0][1])}: {RULE}")

    def column(name):
        return np.array([_number(path, line, row, header, name) for line, row in rows[1:]])

    displacement = np.column_stack([column(name) for name in motion])
    if None not in at:
        return np.column_stack([column(name) for name in at]), None, displacement
    ids = column("id")
    if not (ids == np.round(ids)).all():
        raise InputError(f"{path}: column id must hold whole numbers")
    return None, ids.astype(np.int64), displacement


def _number(path, line, row, header, name):
    """A finite number of a row. Raises InputError."""
    try:
        value = float(row[header.index(name)]) if len(row) == len(header) else None
    except ValueError:
        raise InputError(f"{path}:{line}: column '{name}': must be a number") from None
    if value is None:
        raise InputError(f"{path}:{line}: {len(row)} cells; {len(header)} are required, as above")
    if not math.isfinite(value):
        raise InputError(f"{path}:{line}: column '{name}': {value} must be finite")
    return value
