"""Reads result files of CalculiX (.frd, ASCII): nodes and their displacements."""

import re
from pathlib import Path

import numpy as np

from common.errors import InputError

NUMBER = re.compile(r"[-+]?\d\.\d+E[-+]\d{2,3}")


def read(path):
    """(points (n, 3), displacement (n, 3)) in m, of the last displacement block of a file.

    ccx writes six digits. Nodes without a displacement are left out; they belong to no element.
    Raises InputError naming the line and the rule if the file cannot be read or is damaged.
    """
    points, displacement = _blocks(path)
    if not points:
        raise InputError(f"{path}: no nodes: a block '    2C' is required")
    for node in displacement:
        if node not in points:
            raise InputError(f"{path}: node {node} of the block DISP has no coordinates")
    nodes = sorted(displacement)
    return tuple(np.array([found[node] for node in nodes]) for found in (points, displacement))


def _blocks(path):
    """(id -> coordinates, id -> displacement) of the nodes. Raises InputError."""
    try:
        text = Path(path).read_text(encoding="ascii")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read as an ASCII .frd file: {error}") from error
    points, displacement, name, begin, ended = {}, {}, "", 0, True
    for number, line in enumerate(text.splitlines(), start=1):
        if line.startswith("    2C"):
            name, begin, ended, found = "2C", number, False, points
        elif line.startswith(" -4"):
            name = line.split()[1:2] == ["DISP"] and "DISP" or ""
            if name:
                begin, ended, found = number, False, displacement
                found.clear()
        elif name and line.startswith(" -3"):
            name, ended = "", True
        elif name and line.startswith(" -1"):
            _read_node(f"{path}:{number}", line, found)
    if not displacement:
        raise InputError(f"{path}: no displacements: a block ' -4  DISP' is required")
    if not ended:
        raise InputError(f"{path}:{begin}: the block {name} has no end: ' -3' is required")
    return points, displacement


def _read_node(where, line, found):
    """Adds the node of a line. Fields have fixed widths: a minus sign may leave no gap between."""
    node, numbers = line[3:13].strip(), NUMBER.findall(line[13:])
    whole = "".join(numbers) == "".join(line[13:].split())
    if not (node.isdigit() and whole and len(numbers) == 3):
        raise InputError(
            f"{where}: {line.strip()!r}: ' -1', a node number and three numbers are required"
        )
    if int(node) in found:
        raise InputError(f"{where}: node {int(node)} is given twice")
    found[int(node)] = [float(word) for word in numbers]
