"""Meshes as other programs describe them, with their own numbering, and their conversion."""

from dataclasses import dataclass, field

import numpy as np

from common.errors import InputError
from common.hexahedron import LEXICOGRAPHIC
from exchange import orientation

HEXAHEDRON = "hexahedron"
SHOWN = 3  # of faulty items listed in a message
LARGEST = 20.0  # m; a larger mesh was perhaps meant in millimetres


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

    hint: how to make and save hexahedra with the program, for messages. element_sets: name -> ids
    of elements; only hexahedra count.
    """

    node_ids: np.ndarray
    points: np.ndarray
    blocks: list
    sets: dict = field(default_factory=dict)
    hint: str = ""
    element_sets: dict = field(default_factory=dict)


@dataclass(frozen=True)
class HexMesh:
    """points (n, 3) in m, cells (m, 8) in VTK order, sets: name -> sorted nodes, from 0.

    element_sets: name -> sorted elements.
    """

    points: np.ndarray
    cells: np.ndarray
    sets: dict
    element_sets: dict = field(default_factory=dict)


def to_hexahedra(mesh, path, warn):
    """The checked hexahedra of a ForeignMesh, with their nodes and node sets.

    path: for messages. warn: called with the text of each warning. Elements of lower dimension
    serve only to define sets. Returns a HexMesh in the order of the file. Raises InputError.
    """
    order = _checked_nodes(mesh, path)
    block = _hexahedra(mesh, path)
    cells = _rows(mesh, order, block, path)
    _reject(
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
            f"dropped {_count(unused.size, 'node')} of no hexahedron, hence without mass: "
            + _listed(mesh.node_ids[unused])
        )
    points = mesh.points[used]
    _warn_of_seams(points, mesh.node_ids[used], warn)
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    if size > LARGEST:
        warn(f"the mesh is {size:.3g} m across: coordinates are read as metres")
    sets = {}
    for name, ids in mesh.sets.items():
        nodes = np.intersect1d(used, _find(mesh, order, ids, f"{path}: set '{name}'"))
        if not nodes.size:
            warn(f"dropped set '{name}': it has no node of a hexahedron")
        elif (plain := name.replace("/", "_")) in sets:
            raise InputError(f"{path}: two sets are named '{plain}'; names must differ")
        else:
            sets[plain] = np.searchsorted(used, nodes)
            if plain != name:
                warn(f"set '{name}' is renamed '{plain}': names must not contain '/'")
    element_sets = {}
    for name, ids in mesh.element_sets.items():
        members = np.flatnonzero(np.isin(block.ids, ids))
        if members.size:
            element_sets[name.replace("/", "_")] = members
    return HexMesh(points, compact.reshape(cells.shape), sets, element_sets)


def _checked_nodes(mesh, path):
    """The order that sorts the ids of the nodes. Raises InputError for invalid nodes."""
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
        raise InputError(f"{path}: {_nodes(twice)} given twice; ids of nodes must be unique")
    return order


def _hexahedra(mesh, path):
    """All eight-node hexahedra as one Block. Raises InputError for other volume elements."""
    volumes = [block for block in mesh.blocks if block.dimension == 3 and len(block.ids)]
    found = [block for block in volumes if block.kind == HEXAHEDRON]
    others = {}
    for block in volumes:
        if block.kind != HEXAHEDRON:
            others[block.kind] = others.get(block.kind, 0) + len(block.ids)
    if others:
        listed = ", ".join(f"{count} of type '{kind}'" for kind, count in sorted(others.items()))
        raise InputError(
            f"{path}: has non-hexahedral elements: {listed}, besides "
            f"{sum(len(block.ids) for block in found)} hexahedra; only eight-node hexahedra are "
            f"allowed, and elements of lower dimension to define sets{mesh.hint}"
        )
    if not found:
        lower = sorted({block.kind for block in mesh.blocks if len(block.ids)})
        kinds = f"only {', '.join(lower)}" if lower else "no elements"
        raise InputError(f"{path}: has {kinds}; eight-node hexahedra are required{mesh.hint}")
    ids = np.concatenate([block.ids for block in found])
    nodes = np.concatenate([block.nodes for block in found])
    kept = np.sort(np.unique(np.column_stack([ids, nodes]), axis=0, return_index=True)[1])
    ids, nodes = ids[kept], nodes[kept]  # identical duplicates are allowed
    values, counts = np.unique(ids, return_counts=True)
    _reject(path, values[counts > 1], len(ids), "share an id with another; ids must be unique")
    return Block(HEXAHEDRON, 3, ids, nodes)


def _rows(mesh, order, block, path):
    """The rows of the nodes of a Block. Raises InputError if an element names an unknown node."""
    try:
        return _find(mesh, order, block.nodes, "")
    except InputError:
        known = np.isin(block.nodes, mesh.node_ids)
        element = int(np.flatnonzero(~known.all(axis=1))[0])
        node = block.nodes[element][~known[element]][0]
        raise InputError(
            f"{path}: element {block.ids[element]} names node {node}, which does not exist"
        ) from None


def _find(mesh, order, ids, where):
    """The rows of nodes by their ids. Raises InputError for an unknown id."""
    ids = np.asarray(ids, dtype=np.int64)
    at = np.minimum(np.searchsorted(mesh.node_ids, ids, sorter=order), len(order) - 1)
    rows = order[at]
    missing = ids[mesh.node_ids[rows] != ids]
    if missing.size:
        raise InputError(f"{where} names node {missing.flat[0]}, which does not exist")
    return rows


def _oriented(mesh, block, cells, path, warn):
    """The cells with mirrored ones renumbered. Raises InputError for tangled ones."""
    state = orientation.classify(mesh.points, cells)
    tangled = np.flatnonzero(state == orientation.TANGLED)
    if tangled.size:
        hint = ""
        swapped = orientation.classify(mesh.points, cells[:, LEXICOGRAPHIC])
        if (swapped != orientation.TANGLED).all():
            hint = "; they seem to be numbered with x fastest: swap nodes 3 and 4, and 7 and 8"
        centres = mesh.points[cells[tangled]].mean(axis=1)
        places = [
            f"{block.ids[e]} at ({', '.join(f'{x:.6g}' for x in centre)})"
            for e, centre in zip(tangled[:SHOWN], centres)
        ]
        raise InputError(
            f"{path}: {tangled.size} of {len(cells)} elements are tangled or flat (in the vertex "
            "order of VTK, Gmsh and Abaqus, det J must have one sign at all Gauss points): "
            f"{', '.join(places)}{', ...' if tangled.size > SHOWN else ''}{hint}"
        )
    mirrored = np.flatnonzero(state == orientation.MIRRORED)
    if mirrored.size:
        cells = cells.copy()
        cells[mirrored] = cells[mirrored][:, orientation.MIRROR]
        warn(
            f"{mirrored.size} of {len(cells)} elements had a mirrored node order and were "
            f"renumbered: {_listed(block.ids[mirrored])}"
        )
    pair = orientation.overlap(cells)
    if pair:
        first, second = (block.ids[e] for e in pair)
        raise InputError(
            f"{path}: elements {first} and {second} lie on the same side of their common face, "
            "or share it with a third; elements must not overlap"
        )
    return cells


def _warn_of_seams(points, ids, warn):
    """Warns of coincident nodes: the body is not connected there."""
    order = np.lexsort(points.T)
    same = (points[order][1:] == points[order][:-1]).all(axis=1)
    if same.any():
        first = int(np.flatnonzero(same)[0])
        warn(
            f"{_count(int(same.sum()), 'node')} coincident with another, such as "
            f"{ids[order[first]]} and {ids[order[first + 1]]}: the body is not connected there"
        )


def _reject(path, ids, total, rule):
    """Raises InputError if there are elements that break a rule."""
    if len(ids):
        raise InputError(f"{path}: {len(ids)} of {total} elements {rule}: {_listed(ids)}")


def _count(number, word):
    return f"{number} {word}{'' if number == 1 else 's'}"


def _nodes(ids):
    return f"{'node' if len(ids) == 1 else 'nodes'} {_listed(ids)}"


def _listed(ids):
    """The first few ids, as text."""
    return ", ".join(map(str, ids[:SHOWN])) + (", ..." if len(ids) > SHOWN else "")
