"""A mesh as other programs describe it, by numbers of their own, on its way to one of hexahedra."""

from dataclasses import dataclass, field

import numpy as np

from common.errors import InputError
from common.hexahedron import LEXICOGRAPHIC
from exchange import orientation

HEXAHEDRON = "hexahedron"
SHOWN = 3  # of what is wrong, in a message
LARGEST = 20.0  # m; what is larger was perhaps meant in millimetres


@dataclass(frozen=True)
class Block:
    """Elements of one kind: ids (m,), nodes (m, k) by their ids; dimension 0 to 3."""

    kind: str
    dimension: int
    ids: np.ndarray
    nodes: np.ndarray


@dataclass
class ForeignMesh:
    """Nodes (n,) with points (n, 3), blocks of elements, and node sets: name -> ids of nodes.

    hint: how the program makes hexahedra and saves them, for those whose file has others or none.
    """

    node_ids: np.ndarray
    points: np.ndarray
    blocks: list
    sets: dict = field(default_factory=dict)
    hint: str = ""


@dataclass(frozen=True)
class HexMesh:
    """points (n, 3) in m, cells (m, 8) in VTK order, sets: name -> sorted nodes; from 0 on."""

    points: np.ndarray
    cells: np.ndarray
    sets: dict


def to_hexahedra(mesh, path, warn):
    """The hexahedra of a ForeignMesh, checked, with the nodes and node sets that belong to them.

    path: for messages. warn: is called with what was put right. Elements of lower dimension have
    named their sets and are left out. Returns a HexMesh in the order of the file.
    Raises InputError.
    """
    order = _checked_nodes(mesh, path)
    block = _hexahedra(mesh, path)
    cells = _rows(mesh, order, block, path)
    _refuse(
        path,
        block.ids[[len(set(cell)) < 8 for cell in cells.tolist()]],
        len(cells),
        "name a node twice; a hexahedron has eight nodes",
    )
    cells = _oriented(mesh, block, cells, path, warn)
    used, compact = np.unique(cells, return_inverse=True)
    unused = np.setdiff1d(np.arange(len(mesh.points)), used)
    if unused.size:
        warn(
            f"{_count(unused.size, 'node')} of no hexahedron left out, as they have no mass: "
            + _listed(mesh.node_ids[unused])
        )
    points = mesh.points[used]
    _warn_of_seams(points, mesh.node_ids[used], warn)
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    if size > LARGEST:
        warn(f"the mesh is {size:.3g} m from corner to corner: coordinates are taken as metres")
    sets = {}
    for name, ids in mesh.sets.items():
        nodes = np.intersect1d(used, _find(mesh, order, ids, f"{path}: set '{name}'"))
        if not nodes.size:
            warn(f"set '{name}' has no node of a hexahedron: left out")
        elif (plain := name.replace("/", "_")) in sets:
            raise InputError(f"{path}: two sets are called '{plain}'; names must differ")
        else:
            sets[plain] = np.searchsorted(used, nodes)
            if plain != name:
                warn(f"set '{name}' is called '{plain}': names have no '/'")
    return HexMesh(points, compact.reshape(cells.shape), sets)


def _checked_nodes(mesh, path):
    """The order that sorts the ids of the nodes. Raises InputError where nodes are no nodes."""
    if not len(mesh.points):
        raise InputError(f"{path}: has no nodes; a mesh of hexahedra is required")
    lost = mesh.node_ids[~np.isfinite(mesh.points).all(axis=1)]
    if lost.size:
        raise InputError(f"{path}: coordinates must be finite; those of {_nodes(lost)} are not")
    order = np.argsort(mesh.node_ids, kind="stable")
    ids = mesh.node_ids[order]
    if ids[0] < 0:
        raise InputError(f"{path}: node {ids[0]}: ids of nodes must not be negative")
    twice = np.unique(ids[1:][ids[1:] == ids[:-1]])
    if twice.size:
        raise InputError(f"{path}: {_nodes(twice)} given twice; ids of nodes must differ")
    return order


def _hexahedra(mesh, path):
    """All hexahedra of eight nodes as one Block. Raises InputError where there are others."""
    volumes = [block for block in mesh.blocks if block.dimension == 3 and len(block.ids)]
    found = [block for block in volumes if block.kind == HEXAHEDRON]
    others = {}
    for block in volumes:
        if block.kind != HEXAHEDRON:
            others[block.kind] = others.get(block.kind, 0) + len(block.ids)
    if others:
        told = ", ".join(f"{count} of type '{kind}'" for kind, count in sorted(others.items()))
        raise InputError(
            f"{path}: has elements that are no hexahedra: {told}, beside "
            f"{sum(len(block.ids) for block in found)} hexahedra; allowed are hexahedra of eight "
            f"nodes; elements of lower dimension only name sets{mesh.hint}"
        )
    if not found:
        lower = sorted({block.kind for block in mesh.blocks if len(block.ids)})
        told = f"only {', '.join(lower)}" if lower else "no elements"
        raise InputError(f"{path}: has {told}; hexahedra of eight nodes are required{mesh.hint}")
    ids = np.concatenate([block.ids for block in found])
    nodes = np.concatenate([block.nodes for block in found])
    kept = np.sort(np.unique(np.column_stack([ids, nodes]), axis=0, return_index=True)[1])
    ids, nodes = ids[kept], nodes[kept]  # what is said twice in the same words is said once
    values, counts = np.unique(ids, return_counts=True)
    _refuse(path, values[counts > 1], len(ids), "have an id that others have; ids must differ")
    return Block(HEXAHEDRON, 3, ids, nodes)


def _rows(mesh, order, block, path):
    """The rows of the nodes of a Block. Raises InputError where an element names no node."""
    try:
        return _find(mesh, order, block.nodes, "")
    except InputError:
        known = np.isin(block.nodes, mesh.node_ids)
        element = int(np.flatnonzero(~known.all(axis=1))[0])
        node = block.nodes[element][~known[element]][0]
        raise InputError(
            f"{path}: element {block.ids[element]} names node {node}, which is not there"
        ) from None


def _find(mesh, order, ids, where):
    """The rows of nodes by their ids. Raises InputError for one that is not there."""
    ids = np.asarray(ids, dtype=np.int64)
    at = np.minimum(np.searchsorted(mesh.node_ids, ids, sorter=order), len(order) - 1)
    rows = order[at]
    missing = ids[mesh.node_ids[rows] != ids]
    if missing.size:
        raise InputError(f"{where} names node {missing.flat[0]}, which is not there")
    return rows


def _oriented(mesh, block, cells, path, warn):
    """The cells with mirrored ones put right. Raises InputError where they are tangled."""
    state = orientation.judge(mesh.points, cells)
    tangled = np.flatnonzero(state == orientation.TANGLED)
    if tangled.size:
        hint = ""
        if (orientation.judge(mesh.points, cells[:, LEXICOGRAPHIC]) != orientation.TANGLED).all():
            hint = "; counted with x fastest they would not be: swap the 3rd with the 4th, 7th, 8th"
        centres = mesh.points[cells[tangled]].mean(axis=1)
        told = [
            f"{block.ids[e]} at ({', '.join(f'{x:.6g}' for x in centre)})"
            for e, centre in zip(tangled[:SHOWN], centres)
        ]
        raise InputError(
            f"{path}: {tangled.size} of {len(cells)} elements are tangled or flat: in no order of "
            "their vertices that VTK, Gmsh and Abaqus share is det J of one sign at Gauss points: "
            f"{', '.join(told)}{', ...' if tangled.size > SHOWN else ''}{hint}"
        )
    mirrored = np.flatnonzero(state == orientation.MIRRORED)
    if mirrored.size:
        cells = cells.copy()
        cells[mirrored] = cells[mirrored][:, orientation.MIRROR]
        warn(
            f"{mirrored.size} of {len(cells)} elements were numbered mirror-wise and are turned "
            f"round: {_listed(block.ids[mirrored])}"
        )
    pair = orientation.overlap(cells)
    if pair:
        first, second = (block.ids[e] for e in pair)
        raise InputError(
            f"{path}: elements {first} and {second} lie on the same side of the face that they "
            "share, or share it with a third; a mesh must fill space once"
        )
    return cells


def _warn_of_seams(points, ids, warn):
    """Tells of nodes at the same place: the body is not joined there."""
    order = np.lexsort(points.T)
    same = (points[order][1:] == points[order][:-1]).all(axis=1)
    if same.any():
        first = int(np.flatnonzero(same)[0])
        warn(
            f"{_count(int(same.sum()), 'node')} at the very place of another, such as "
            f"{ids[order[first]]} and {ids[order[first + 1]]}: the body is not joined there"
        )


def _refuse(path, ids, total, rule):
    """Raises InputError where there are elements that break a rule."""
    if len(ids):
        raise InputError(f"{path}: {len(ids)} of {total} elements {rule}: {_listed(ids)}")


def _count(number, word):
    return f"{number} {word}{'' if number == 1 else 's'}"


def _nodes(ids):
    return f"{'node' if len(ids) == 1 else 'nodes'} {_listed(ids)}"


def _listed(ids):
    """The first of some ids, as text."""
    return ", ".join(map(str, ids[:SHOWN])) + (", ..." if len(ids) > SHOWN else "")
