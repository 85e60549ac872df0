"""Meshes as other programs describe them, with their own numbering, and their conversion."""

import warnings
from dataclasses import dataclass, field

import numpy as np

from common.errors import InputError
from common.hexahedron import LEXICOGRAPHIC
from exchange import orientation

HEXAHEDRON = "hexahedron"
MOST = 2**63 - 1  # the largest whole number
SHOWN = 3  # of faulty items listed in a message
SCOPE = 1 << 40  # numbers of instance i begin at i SCOPE, where a file has several


@dataclass(frozen=True)
class Block:
    """Elements of one kind: ids (m,), nodes (m, k) by their ids; dimension 0 to 3."""

    kind: str
    dimension: int
    ids: np.ndarray
    nodes: np.ndarray


@dataclass
class ForeignMesh:
    """Nodes (n,) with points (n, 3), blocks of elements, and node sets: (scope, name) -> ids.

    The scope of a name is an instance, the assembly, or the dimension of a group; "" without any.
    hint: how to make and save hexahedra with the program, for messages. element_sets: the same for
    ids of elements; those of hexahedra count. scopes: names of the instances that number their
    nodes and elements from i SCOPE on. notes: what was not read, as warnings.
    """

    node_ids: np.ndarray
    points: np.ndarray
    blocks: list
    sets: dict = field(default_factory=dict)
    hint: str = ""
    element_sets: dict = field(default_factory=dict)
    scopes: list = field(default_factory=list)
    notes: list = field(default_factory=list)

    def listed(self, ids):
        """The first few numbers of nodes or elements, as the file has them."""
        shown = [
            f"{self.scopes[int(i) // SCOPE]}.{int(i) % SCOPE}" if self.scopes else str(i)
            for i in ids[:SHOWN]
        ]
        return ", ".join(shown) + (", ..." if len(ids) > SHOWN else "")


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
    for note in mesh.notes:
        warn(note)
    order = _checked_nodes(mesh, path)
    block = _hexahedra(mesh, path)
    cells = _rows(mesh, order, block, path)
    corners = np.sort(cells, axis=1)
    twice = block.ids[(corners[:, 1:] == corners[:, :-1]).any(axis=1)]
    _reject(mesh, path, twice, len(cells), "name a node twice; a hexahedron has eight nodes")
    cells = _oriented(mesh, block, cells, path, warn)
    rank = np.full(len(mesh.points), -1)
    rank[cells] = 0
    if (lost := np.flatnonzero(rank < 0)).size:
        warn(
            f"dropped {_count(lost.size, 'node')} of no hexahedron, hence without mass: "
            + mesh.listed(mesh.node_ids[lost])
        )
    used = np.flatnonzero(rank == 0)
    rank[used] = np.arange(len(used))
    sets = {}
    for (scope, name), ids in mesh.sets.items():
        nodes = rank[_find(mesh, order, ids, f"{path}: set '{name}'")]
        sets[scope, name] = np.unique(nodes[nodes >= 0])
        if not sets[scope, name].size:
            warn(f"dropped set '{name}': it has no node of a hexahedron")
    element_sets = {
        key: np.flatnonzero(np.isin(block.ids, ids)) for key, ids in mesh.element_sets.items()
    }
    return HexMesh(
        mesh.points[used], rank[cells], _named(sets, path, warn), _named(element_sets, path)
    )


def _named(sets, path, warn=lambda text: None):
    """name -> members, of (scope, name) -> members without the empty ones.

    A name with several meanings becomes SCOPE.NAME for each of them; alone it names no set, so a
    case that uses it is refused. Raises InputError if names clash.
    """
    alike, named = {}, {}
    for (scope, name), members in sets.items():
        if members.size:
            alike.setdefault(name, []).append((scope, members))
    for name, some in alike.items():
        same = all(np.array_equal(some[0][1], members) for _, members in some)
        for scope, members in some[:1] if same else some:
            full = name if same else f"{scope or 'Set'}.{name}"
            plain = full.replace("/", "_")
            if plain in named:
                raise InputError(f"{path}: two sets are named '{plain}'; names must differ")
            if plain != full:
                warn(f"set '{full}' is renamed '{plain}': names must not contain '/'")
            named[plain] = members
    return named


def _checked_nodes(mesh, path):
    """The order that sorts the ids of the nodes. Raises InputError for invalid nodes."""
    if not len(mesh.points):
        raise InputError(f"{path}: has no nodes; a mesh of hexahedra is required")
    lost = mesh.node_ids[~np.isfinite(mesh.points).all(axis=1)]
    if lost.size:
        raise InputError(
            f"{path}: coordinates must be finite; those of {_nodes(mesh, lost)} are not"
        )
    order = np.argsort(mesh.node_ids, kind="stable")
    ids = mesh.node_ids[order]
    if ids[0] < 0:
        raise InputError(f"{path}: node {ids[0]}: ids of nodes must not be negative")
    twice = np.unique(ids[1:][ids[1:] == ids[:-1]])
    if twice.size:
        raise InputError(f"{path}: {_nodes(mesh, twice)} given twice; ids of nodes must be unique")
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
        hint = mesh.hint or "; mesh volumes with hexahedra of first order"
        raise InputError(
            f"{path}: has non-hexahedral elements: {listed}, besides "
            f"{sum(len(block.ids) for block in found)} hexahedra; only eight-node hexahedra are "
            f"allowed, and elements of lower dimension to define sets{hint}"
        )
    if not found:
        lower = sorted({block.kind for block in mesh.blocks if len(block.ids)})
        kinds = f"only {', '.join(lower)}" if lower else "no elements"
        raise InputError(f"{path}: has {kinds}; eight-node hexahedra are required{mesh.hint}")
    ids = np.concatenate([block.ids for block in found])
    nodes = np.concatenate([block.nodes for block in found])
    if len(np.unique(ids)) < len(ids):  # identical duplicates are allowed
        kept = np.sort(np.unique(np.column_stack([ids, nodes]), axis=0, return_index=True)[1])
        ids, nodes = ids[kept], nodes[kept]
        values, counts = np.unique(ids, return_counts=True)
        rule = "share an id with another; ids must be unique"
        _reject(mesh, path, values[counts > 1], len(ids), rule)
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
            f"{path}: element {mesh.listed([block.ids[element]])} names node "
            f"{mesh.listed([node])}, which does not exist"
        ) from None


def _find(mesh, order, ids, where):
    """The rows of nodes by their ids. Raises InputError for an unknown id."""
    ids = np.asarray(ids, dtype=np.int64)
    at = np.minimum(np.searchsorted(mesh.node_ids, ids, sorter=order), len(order) - 1)
    rows = order[at]
    missing = ids[mesh.node_ids[rows] != ids]
    if missing.size:
        raise InputError(
            f"{where} names node {mesh.listed([missing.flat[0]])}, which does not exist"
        )
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
            f"{mesh.listed([block.ids[e]])} at ({', '.join(f'{x:.6g}' for x in centre)})"
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
            f"renumbered: {mesh.listed(block.ids[mirrored])}"
        )
    if pair := orientation.overlap(cells):
        first, second = (mesh.listed([block.ids[e]]) for e in pair)
        raise InputError(
            f"{path}: elements {first} and {second} lie on the same side of their common face, "
            "or share it with a third; elements must not overlap"
        )
    return cells


def _reject(mesh, path, ids, total, rule):
    """Raises InputError if there are elements that break a rule."""
    if len(ids):
        raise InputError(f"{path}: {len(ids)} of {total} elements {rule}: {mesh.listed(ids)}")


def content(path):
    """The bytes of a file of text without a byte order mark. Raises InputError."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise InputError(f"{path}: is text in UTF-16; save it as UTF-8")
    return data.removeprefix(b"\xef\xbb\xbf")


def decoded(data):
    """The text of bytes: UTF-8, else the Western European encoding of Windows."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("cp1252", "replace")


class NotNumber(ValueError):
    """Of a word that is no number; at: its place among the words."""

    def __init__(self, word, what, at):
        text = word.decode("utf-8", "replace") if isinstance(word, bytes) else word
        super().__init__(f"{text[:40]!r} is not a {what}")
        self.at = at


def word_starts(data):
    """Where the words of a text of bytes begin, (n,)."""
    printed = np.frombuffer(data, "u1") > ord(" ")
    return np.flatnonzero(printed & ~np.append(False, printed[:-1]))


def parsed(text, kind, separator):
    """The numbers (n,) of a text, as "f8" or "i8"; none where another word is among them."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        try:
            return np.fromstring(text, kind, sep=separator)
        except DeprecationWarning:
            return np.empty(0, kind)


def as_numbers(text, kind):
    """All numbers (n,) of a text, as "f8" or "i8". Raises NotNumber."""
    data = text.encode() if isinstance(text, str) else bytes(text)
    found = parsed(data, kind, " ")
    # NumPy takes 1-2 for two numbers, and the largest number for larger ones.
    if len(found) == len(word_starts(data)) and (kind[0] == "f" or (abs(found) < MOST).all()):
        return found
    read, what = (float, "number") if kind[0] == "f" else (int, "whole number")
    numbers = []
    for at, word in enumerate(data.split()):
        try:
            numbers.append(read(word))
            if word.isascii() and b"_" not in word and (kind[0] == "f" or abs(numbers[-1]) < MOST):
                continue
        except ValueError:
            pass
        raise NotNumber(word, what, at)
    return np.array(numbers, dtype=kind)


def fitting(values, kind):
    """Whole numbers (n,) as a smaller type. Raises NotNumber for one that it cannot hold."""
    found = values.astype(kind)
    if (found != values).any():
        at = int(np.flatnonzero(found != values)[0])
        raise NotNumber(str(values[at]), f"number of type {found.dtype}", at)
    return found


def _count(number, word):
    return f"{number} {word}{'' if number == 1 else 's'}"


def _nodes(mesh, ids):
    return f"{'node' if len(ids) == 1 else 'nodes'} {mesh.listed(ids)}"
