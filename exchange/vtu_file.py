"""Reads meshes and displacements from VTK's grids (.vtu, .vtk); writes .vtu and XDMF."""

import numpy as np

from common.errors import InputError
from common.hexahedron import LEXICOGRAPHIC
from exchange.foreign_mesh import HEXAHEDRON, Block, ForeignMesh
from exchange.vtk_reader import LegacyGrid
from exchange.vtu_reader import Grid

# VTK's number of a cell: name, dimension; others count as volumes, which are refused.
KINDS = {
    1: ("vertex", 0),
    3: ("line", 1),
    5: ("triangle", 2),
    8: ("pixel", 2),
    9: ("quad", 2),
    10: ("tetra", 3),
    11: (HEXAHEDRON, 3),
    12: (HEXAHEDRON, 3),
    13: ("wedge", 3),
    14: ("pyramid", 3),
    21: ("quadratic edge", 1),
    22: ("quadratic triangle", 2),
    23: ("quadratic quad", 2),
    25: ("quadratic hexahedron", 3),
}
VOXEL = 11

GHOSTS = "vtkGhostType"  # VTK's array of cells that repeat others, or are not shown

# An array with more values does not hold labels, but perhaps element numbers.
MOST_LABELS = 1000

DISPLACEMENTS = ("displacement", "displacements", "u", "disp")


def read(path):
    """The ForeignMesh of a .vtu or .vtk file; ids count from 0. Raises InputError.

    Integer point arrays with values 0 and 1 define node sets: 1 marks the nodes of the set.
    Likewise, integer cell arrays define element sets; one with other values (labels) defines a set
    NAME-LABEL for each.
    """
    grid = _grid(path)
    hidden = np.count_nonzero(grid.cell_data.pop(GHOSTS, 0))
    if hidden:
        raise InputError(
            f"{path}: {hidden} of {len(grid.types)} cells are ghosts or hidden by '{GHOSTS}'; "
            "remove them with the program that made the file, or the array if they count"
        )
    sizes, starts = np.diff(grid.offsets, prepend=0), np.append(0, grid.offsets)[:-1]
    blocks = []
    for number in np.unique(grid.types).tolist():
        kind, dimension = KINDS.get(number, (f"VTK's type {number}", 3))
        for size in np.unique(sizes[grid.types == number]):
            ids = np.flatnonzero((grid.types == number) & (sizes == size))
            nodes = grid.connectivity[starts[ids][:, None] + np.arange(size)]
            if kind == HEXAHEDRON and size != 8:
                raise InputError(f"{path}: cell {ids[0]} has {size} nodes; a hexahedron has eight")
            blocks.append(
                Block(kind, dimension, ids, nodes[:, LEXICOGRAPHIC] if number == VOXEL else nodes)
            )
    sets = {
        ("", name): np.flatnonzero(data)
        for name, data in grid.point_data.items()
        if data.ndim == 1 and data.dtype.kind in "biu" and np.isin(data, (0, 1)).all()
    }
    element_sets = {}
    for name, data in grid.cell_data.items():
        if data.ndim == 1 and data.dtype.kind in "biu":
            found = _labelled(name, data)
            if twice := found.keys() & element_sets.keys():
                name = next(iter(twice))[1]
                raise InputError(f"{path}: two cell arrays define element set '{name}'; rename one")
            element_sets |= found
    ids = np.arange(len(grid.points))
    return ForeignMesh(ids, grid.points, blocks, sets, element_sets=element_sets)


def _grid(path):
    return (LegacyGrid if path.suffix.lower() == ".vtk" else Grid)(path)


def _labelled(name, data):
    """The element sets of an integer cell array."""
    labels = np.unique(data)
    if np.isin(labels, (0, 1)).all():
        return {("", name): np.flatnonzero(data)}
    if len(labels) > MOST_LABELS:
        return {}
    return {("", f"{name}-{label}"): np.flatnonzero(data == label) for label in labels}


def read_displacement(path, field):
    """(points (n, 3), displacement (n, 3)), m, of a .vtu or .vtk file.

    field: name of the point array; None means one of DISPLACEMENTS, which is not case-sensitive.
    Raises InputError.
    """
    grid = _grid(path)
    vectors = {n: d for n, d in grid.point_data.items() if d.ndim == 2 and d.shape[1] == 3}
    wanted = [field] if field else [n for n in vectors if n.lower() in DISPLACEMENTS]
    if len(wanted) != 1 or wanted[0] not in vectors:
        names = ", ".join(f"'{name}'" for name in vectors) or "none"
        raise InputError(
            f"{path}: cannot tell which point array holds the displacements; choose one with "
            f"--field NAME; its arrays of three components: {names}"
        )
    return grid.points, np.asarray(vectors[wanted[0]], dtype=float)


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
