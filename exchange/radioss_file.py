"""Reads displacements from an animation file of OpenRadioss (NAMEA001), written with
/ANIM/VECT/DISP: big-endian numbers, in single precision."""

import re

import numpy as np

from common.errors import InputError

NAME = re.compile(r".*A\d{3}")
MAGIC = 0x542C
TEXT = 81  # characters of a name
DISPLACEMENT = "displacement"


def is_animation(path):
    """Whether a file is named like an animation file, which has no extension."""
    return bool(NAME.fullmatch(path.name))


def read_displacement(path):
    """(points (n, 3), displacement (n, 3)), m, in the program's own order. Raises InputError."""
    try:
        with open(path, "rb") as file:
            return _displacement(path, file)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except (ValueError, IndexError) as error:
        raise InputError(f"{path}: ends too early for an animation file of OpenRadioss") from error


def _displacement(path, file):
    def read(kind, count):
        data = np.dtype(kind)
        return np.frombuffer(file.read(count * data.itemsize), dtype=data, count=count)

    if read(">i4", 1)[0] != MAGIC:
        raise InputError(f"{path}: is not an animation file of OpenRadioss")
    read(">f4", 1)  # time
    read("S1", 3 * TEXT)
    read(">i4", 10)  # flags
    nodes, facets, parts, scalars, facet_scalars, vectors, _, skews = read(">i4", 8).tolist()
    read(">u2", 6 * skews)
    positions = read(">f4", 3 * nodes).reshape(nodes, 3).astype(float)  # current ones
    read(">i4", 4 * facets)
    read("S1", facets)
    read(">i4", parts)
    read("S1", 50 * parts)
    read(">u2", 3 * nodes)  # normals
    read("S1", TEXT * (scalars + facet_scalars))
    read(">f4", nodes * scalars + facets * facet_scalars)
    names = [
        text.decode(errors="replace").strip("\0 ").lower() for text in read(f"S{TEXT}", vectors)
    ]
    place = next((i for i, name in enumerate(names) if name.startswith(DISPLACEMENT)), None)
    if place is None:
        raise InputError(f"{path}: has no displacements; the engine file needs /ANIM/VECT/DISP")
    values = read(">f4", 3 * nodes * vectors).reshape(vectors, nodes, 3)[place].astype(float)
    return positions - values, values
