"""Reads and writes VTK's unstructured grids (.vtu) and writes XDMF, with meshio."""

import contextlib
import io
import re
import warnings

import numpy as np

from common.errors import InputError
from exchange.foreign_mesh import Block, ForeignMesh

# An array with more values does not hold labels, but perhaps element numbers.
MOST_LABELS = 1000

DISPLACEMENTS = ("displacement", "displacements", "u", "disp")


def read(path):
    """The ForeignMesh of a .vtu file; ids count from 0. Raises InputError.

    Integer point arrays with values 0 and 1 define node sets: 1 marks the nodes of the set.
    Likewise, integer cell arrays define element sets; one with other values (labels) defines a set
    NAME-LABEL for each.
    """
    grid = _read(path)
    ids, first = np.arange(len(grid.points)), 0
    blocks = []
    for block in grid.cells:
        numbers = np.arange(first, first + len(block.data))
        first += len(block.data)
        nodes = np.asarray(block.data, dtype=np.int64)
        blocks.append(Block(block.type, block.dim, numbers, nodes))
    sets = {
        name: np.flatnonzero(data)
        for name, data in grid.point_data.items()
        if data.ndim == 1 and data.dtype.kind in "biu" and np.isin(data, (0, 1)).all()
    }
    element_sets = {}
    for name, parts in grid.cell_data.items():
        data = np.concatenate(parts)
        if data.ndim == 1 and data.dtype.kind in "biu":
            element_sets |= _labelled(name, data)
    points = np.asarray(grid.points, dtype=float)
    return ForeignMesh(ids, points, blocks, sets, element_sets=element_sets)


def _labelled(name, data):
    """The element sets of an integer cell array."""
    labels = np.unique(data)
    if np.isin(labels, (0, 1)).all():
        return {name: np.flatnonzero(data)}
    if len(labels) > MOST_LABELS:
        return {}
    return {f"{name}-{label}": np.flatnonzero(data == label) for label in labels}


def read_displacement(path, field):
    """(points (n, 3), displacement (n, 3)), m, of a .vtu file.

    field: name of the point array; None means one of DISPLACEMENTS, which is not case-sensitive.
    Raises InputError.
    """
    grid = _read(path)
    vectors = {n: d for n, d in grid.point_data.items() if d.ndim == 2 and d.shape[1] == 3}
    wanted = [field] if field else [n for n in vectors if n.lower() in DISPLACEMENTS]
    if len(wanted) != 1 or wanted[0] not in vectors:
        names = ", ".join(f"'{name}'" for name in vectors) or "none"
        raise InputError(
            f"{path}: cannot tell which point array holds the displacements; choose one with "
            f"--field NAME; its arrays of three components: {names}"
        )
    return np.asarray(grid.points, dtype=float), np.asarray(vectors[wanted[0]], dtype=float)


def write(path, mesh, kind):
    """Writes a HexMesh as "vtu" or "xdmf", each of its sets as an array of 0 and 1."""
    import meshio  # imported only where needed, as it is slow to load

    inside = {}
    for name, nodes in mesh.sets.items():
        inside[name] = np.zeros(len(mesh.points), dtype=np.int32)
        inside[name][nodes] = 1
    marked = {}
    for name, elements in mesh.element_sets.items():
        marked[name] = [np.zeros(len(mesh.cells), dtype=np.int32)]
        marked[name][0][elements] = 1
    cells = [("hexahedron", mesh.cells)]
    grid = meshio.Mesh(mesh.points, cells, point_data=inside, cell_data=marked)
    if kind == "vtu":
        meshio.vtu.write(path, grid)
    else:
        meshio.xdmf.write(path, grid, data_format="XML")


def _read(path):
    """meshio's grid of a file. Raises InputError if it cannot read the file or would misread it."""
    import meshio

    said = io.StringIO()
    try:
        with open(path, "rb") as file:
            pieces = len(re.findall(rb"<Piece[\s>]", file.read()))
        if pieces > 1:  # meshio would keep the cells of the last one only
            raise InputError(f"{path}: has {pieces} pieces; one is required")
        with contextlib.redirect_stderr(said), warnings.catch_warnings():
            warnings.simplefilter("error")
            grid = meshio.vtu.read(path)
    except (InputError, MemoryError):
        raise
    except BaseException as error:  # a library may fail in any way on a damaged file
        raise _refusal(path, str(error) or "it is damaged, or cut off") from error
    if said.getvalue():  # meshio warns and continues if it skips something
        raise _refusal(path, said.getvalue())
    if grid.points.ndim != 2 or grid.points.shape[1] != 3:
        raise InputError(f"{path}: points have {grid.points.shape[1:]} components; 3 are required")
    return grid


def _refusal(path, reason):
    words = " ".join(reason.split()).removeprefix("Warning: ")
    return InputError(f"{path}: cannot be read as a .vtu grid: {words[:200]}")
