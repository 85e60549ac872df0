"""Reads the displacements of the last step that NiftySim, FEBio and SOFA write as text."""

import numpy as np

from common.errors import InputError


def read_niftysim(path):
    """Displacement (n, 3), m, of U.txt: a row for each component of a node, a column for each time.

    Raises InputError.
    """
    rows = [line.split() for line in _lines(path) if line.strip()]
    if not rows or len(rows) % 3 or len({len(row) for row in rows}) > 1:
        raise InputError(f"{path}: rows of equally many numbers are required, three for each node")
    return _numbers(path, [row[-1] for row in rows]).reshape(-1, 3)


def read_febio(path):
    """(ids (n,), displacement (n, 3)), m, of a log of node_data ux;uy;uz. Raises InputError."""
    lines = _lines(path)
    starts = [i for i, line in enumerate(lines) if line.startswith("*Data")]
    if not starts or lines[starts[-1]].split("=")[-1].strip() != "ux;uy;uz":
        raise InputError(f"{path}: a block of <node_data data='ux;uy;uz'> is required")
    rows = [line.replace(",", " ").split() for line in lines[starts[-1] + 1 :] if line.strip()]
    if not rows or {len(row) for row in rows} != {4}:
        raise InputError(f"{path}: the last block must have an id and three numbers in each row")
    table = _numbers(path, [cell for row in rows for cell in row]).reshape(-1, 4)
    return table[:, 0].astype(np.int64), table[:, 1:]


def read_sofa(path):
    """Displacement (n, 3), m, of a file of WriteState (writeX, writeX0). Raises InputError."""
    found = {}
    for line in _lines(path):
        key, separator, numbers = line.strip().partition("=")
        if separator and key in ("X", "X0"):
            found[key] = _numbers(path, numbers.split())
    if set(found) != {"X", "X0"} or len(found["X"]) != len(found["X0"]) or len(found["X"]) % 3:
        raise InputError(f"{path}: lines X= and X0= of equally many positions are required")
    return (found["X"] - found["X0"]).reshape(-1, 3)


def _lines(path):
    try:
        return path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read as text: {error}") from error


def _numbers(path, words):
    try:
        return np.array(words, dtype=float)
    except ValueError as error:
        raise InputError(f"{path}: {error}") from error
