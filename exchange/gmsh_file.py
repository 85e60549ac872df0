"""Reads Gmsh's .msh, versions 2.2 and 4.1, text and binary.

Physical groups become node sets, groups of volumes also element sets.

meshio is not used: it loses groups of surfaces that are named with a minus sign, groups of the same
name and unnamed groups, and takes an unknown node for the last one.
"""

import re

import numpy as np

from common.errors import InputError
from exchange.foreign_mesh import HEXAHEDRON, MOST, Block, ForeignMesh, NotNumber
from exchange.foreign_mesh import as_numbers, content, decoded

# Gmsh's number of an element type: name, dimension, nodes.
KINDS = {
    15: ("point", 0, 1),
    1: ("line", 1, 2),
    8: ("line of 3 nodes", 1, 3),
    2: ("triangle", 2, 3),
    9: ("triangle of 6 nodes", 2, 6),
    3: ("quadrilateral", 2, 4),
    16: ("quadrilateral of 8 nodes", 2, 8),
    10: ("quadrilateral of 9 nodes", 2, 9),
    4: ("tetrahedron", 3, 4),
    11: ("tetrahedron of 10 nodes", 3, 10),
    5: (HEXAHEDRON, 3, 8),
    17: ("hexahedron of 20 nodes", 3, 20),
    12: ("hexahedron of 27 nodes", 3, 27),
    6: ("wedge", 3, 6),
    18: ("wedge of 15 nodes", 3, 15),
    13: ("wedge of 18 nodes", 3, 18),
    7: ("pyramid", 3, 5),
    19: ("pyramid of 13 nodes", 3, 13),
    14: ("pyramid of 14 nodes", 3, 14),
}
DIMENSIONS = ("point", "curve", "surface", "volume")
HINT = (
    "; Gmsh makes them by Recombine Surface with Transfinite Volume, or by Extrude with Layers and "
    "Recombine, meshes volumes with `gmsh -3`, and saves only what is in a physical group where "
    "there is one: Physical Volume"
)


def read(path):
    """The ForeignMesh of a .msh file. Raises InputError."""
    sections = _sections(path, content(path))
    for name in ("MeshFormat", "Nodes", "Elements"):
        if name not in sections:
            raise InputError(f"{path}: section ${name} is missing; not a Gmsh mesh, or truncated")
    if "PartitionedEntities" in sections:
        raise InputError(f"{path}: is partitioned; save it whole, after Mesh > Unpartition in Gmsh")
    words = sections["MeshFormat"].split(None, 3)[:3]
    if len(words) < 3 or words[1] not in (b"0", b"1"):
        raise InputError(f"{path}: $MeshFormat must be a version, 0 or 1, and a size")
    version, binary = words[0].decode("ascii", "replace"), words[1] == b"1"
    if not (version == "4.1" or re.fullmatch(r"2(\.\d)?", version)):
        raise InputError(
            f"{path}: version {version} of .msh; allowed are 2.2 and 4.1: "
            "gmsh OLD.msh -save -format msh41 -o NEW.msh"
        )
    names = _names(path, sections.get("PhysicalNames", _Section()))
    order = _byte_order(path, sections["MeshFormat"]) if binary else None

    def numbers(section, kind="f8"):
        return _Numbers(path, section, sections[section], order, words[2], kind)

    if version == "4.1":
        return _read_4(numbers, names, "Entities" in sections)
    return _read_2(numbers, names)


class _Numbers:
    """The numbers of a section, one after the other, of text or bytes.

    kind: "i8" if those of a text are whole, else "f8".
    """

    def __init__(self, path, section, data, order, size, kind):
        self.path, self.section, self.first = path, section, data.first
        self.order, self.position = order, 0
        self.text = b"" if order else data
        self.size = "i8" if size == b"8" else "i4"
        try:
            self.data = data if order else as_numbers(data, kind)
        except NotNumber as error:
            self.position = error.at
            raise self.wrong(f"is damaged: {error}") from error

    def wrong(self, reason):
        """The InputError of this reason, with the line of a text."""
        line = self.first + 1
        left = self.position
        for row in self.text.splitlines()[:-1]:
            left -= len(row.split())
            if left < 0:
                break
            line += 1
        line = "" if self.order else f":{line}"
        return InputError(f"{self.path}{line}: ${self.section} {reason}")

    def take(self, count, kind="i4"):
        """The next numbers (count,): of an int, of "size" or of "f8". Raises InputError."""
        kind, count = self.size if kind == "size" else kind, int(count)
        if not 0 <= count <= len(self.data):
            raise self.wrong(f"announces {count} numbers, more than it holds")
        end = self.position + count * (int(kind[1]) if self.order else 1)
        found = self.data[self.position : end]
        if end > len(self.data):
            raise self.wrong("ends too early: it is cut off or damaged")
        self.position = end
        if self.order:
            return np.frombuffer(found, self.order + kind).astype(kind)
        if kind[0] == "i" and self.data.dtype.kind == "f":
            wrong = np.flatnonzero((found != np.round(found)) | ~(abs(found) < 2**53))
            if wrong.size:
                self.position += int(wrong[0]) - count
                raise self.wrong(f"is damaged: '{found[wrong[0]]}' is not a whole number")
        return found.astype(kind[0] + "8", copy=False)

    def end(self, count, announced, things):
        """Raises InputError unless as many things were read as announced, and nothing is left."""
        if count != announced:
            raise self.wrong(f"announces {announced} {things}, but holds {count}")
        left = self.data[self.position :]
        if left.strip() if self.order else len(left):
            raise self.wrong(f"does not end behind its {announced} {things}")

    def kind(self, number):
        """The entry of KINDS for Gmsh's number. Raises InputError."""
        if number not in KINDS:
            rule = "hexahedra of first order are required, which are of type 5"
            raise self.wrong(f"has elements of Gmsh's type {number}; {rule}")
        return KINDS[number]


class _Section(bytes):
    """The content of a section; first: the line of its name."""

    first = 0


def _sections(path, data):
    """The content of the sections of a file by name. Raises InputError if one has no end."""
    sections, position = {}, 0
    while begin := re.compile(rb"^\$(\w+)[ \t]*\r?\n", re.MULTILINE).search(data, position):
        end = data.find(b"$End" + begin[1], begin.end())
        name, line = begin[1].decode("ascii", "replace"), data.count(b"\n", 0, begin.start()) + 1
        if name.startswith("End"):
            raise InputError(f"{path}:{line}: ${name} ends no section: the file is damaged")
        if end < 0:
            rule = f"${name} has no $End{name}: the file is cut off or damaged"
            raise InputError(f"{path}:{line}: {rule}")
        if name in sections and not name.endswith("Data"):
            raise InputError(f"{path}:{line}: ${name} is given twice; one is required")
        sections[name] = _Section(data[begin.end() : end])
        sections[name].first = line
        position = end + 4 + len(begin[1])
    return sections


def _byte_order(path, header):
    """The byte order of a binary file, by the number one in its header."""
    one = header.split(b"\n", 1)[-1][:4]
    if one not in (b"\1\0\0\0", b"\0\0\0\1"):
        raise InputError(f"{path}: $MeshFormat is damaged: a binary file has the number 1 there")
    return "<" if one[0] else ">"


def _names(path, section):
    """(dimension, tag) -> name of the physical groups. Raises InputError."""
    names, lines = {}, decoded(section).splitlines()
    for number, line in enumerate(lines[1:], section.first + 2):
        entry = re.fullmatch(r'\s*([0-3])\s+(-?\d+)\s+"([^"]+)"\s*', line)
        if not entry:
            rule = 'dimension, tag and "name" are required'
            raise InputError(f"{path}:{number}: $PhysicalNames: {line!r}: {rule}")
        names[int(entry[1]), int(entry[2])] = entry[3]
    if lines and lines[0].strip() != str(len(names)):
        rule = f"{lines[0].strip()[:20]!r} names are announced, but {len(names)} given"
        raise InputError(f"{path}:{section.first + 1}: $PhysicalNames: {rule}")
    return names


class _Elements:
    """Collects blocks of elements, and the nodes and volumes of their groups."""

    def __init__(self, names):
        self.names, self.blocks, self.volumes = names, [], {}
        self.groups = {group: [] for group in names}

    def add(self, kind, ids, nodes, groups):
        """Elements of one kind (of KINDS), all in the physical groups of these tags."""
        name, dimension, _ = kind
        self.blocks.append(Block(name, dimension, ids, nodes))
        for tag in {abs(int(tag)) for tag in groups} - {0}:
            self.groups.setdefault((dimension, tag), []).append(nodes.ravel())
            if dimension == 3:
                self.volumes.setdefault((dimension, tag), []).append(ids)

    def mesh(self, node_ids, points):
        """The ForeignMesh. Dimension and tag distinguish groups of the same name."""
        none = np.empty(0, dtype=np.int64)

        def named(groups):
            unique = {g: np.unique(np.concatenate([none, *some])) for g, some in groups.items()}
            scopes = {g: f"{DIMENSIONS[g[0]]}-{g[1]}" for g in unique}
            return {(scopes[g], self.names.get(g, scopes[g])): ids for g, ids in unique.items()}

        sets, volumes = named(self.groups), named(self.volumes)
        return ForeignMesh(node_ids.astype(np.int64), points, self.blocks, sets, HINT, volumes)


def _read_2(numbers, names):
    """Blocks of version 2.2, which lists an element once for each of its groups."""
    nodes, elements = numbers("Nodes"), _Elements(names)
    binary = nodes.order is not None
    if binary:
        count = _line(nodes)
        record = np.dtype([("id", nodes.order + "i4"), ("x", nodes.order + "f8", 3)])
        if nodes.position + count * record.itemsize > len(nodes.data):
            raise nodes.wrong("ends too early: it is cut off or damaged")
        table = np.frombuffer(nodes.data, record, count, nodes.position)
        nodes.position += table.nbytes
        node_ids, points = table["id"], table["x"].astype(float)
    else:
        count = int(nodes.take(1)[0])
        table = nodes.take(4 * count, "f8").reshape(-1, 4)
        node_ids, points = table[:, 0], table[:, 1:]
        if not (node_ids == np.round(node_ids)).all():
            raise nodes.wrong("has a node whose id is not a whole number")
    nodes.end(len(node_ids), count, "nodes")
    source = numbers("Elements", "i8")
    announced = left = _line(source) if binary else int(source.take(1)[0])
    found = {}  # kind -> tables of id, tag of the group, and nodes
    several = 1
    while left > 0:
        if binary:
            number, several, n_tags = source.take(3).tolist()
            if several < 1:
                raise source.wrong(f"has a block of {several} elements")
            kind = source.kind(number)
            rows = source.take(several * (1 + n_tags + kind[2])).reshape(several, -1)
        else:
            _, number, n_tags = source.take(3).tolist()
            kind = source.kind(number)
            source.position -= 3
            # As many rows of this kind as follow, but at most twice as many as the last time.
            width = 3 + max(0, n_tags) + kind[2]
            most = min(2 * several, left, max(1, (len(source.data) - source.position) // width))
            rows = source.take(most * width).reshape(most, width)
            alike = (rows[:, 1:3] == (number, n_tags)).all(axis=1)
            several = most if alike.all() else int(alike.argmin())
            source.position -= (most - several) * width
            rows = np.delete(rows[:several], (1, 2), axis=1)
        left -= several
        tags = rows[:, 1] if n_tags > 0 else np.zeros(several, np.int64)
        table = np.column_stack([rows[:, 0], tags, rows[:, -kind[2] :]]).astype(np.int64)
        found.setdefault(kind, []).append(table)
    source.end(announced - left, announced, "elements")
    for kind, tables in found.items():
        table = np.concatenate(tables)
        ids, nodes = table[_first_alike(table[:, 2:]), 0], table[:, 2:]
        tags, first = np.unique(table[:, 1], return_index=True)
        for tag in tags[np.argsort(first)]:
            inside = table[:, 1] == tag
            elements.add(kind, ids[inside], nodes[inside], [tag])
    return elements.mesh(node_ids, points)


def _first_alike(rows):
    """The first of the rows (m, k) of whole numbers that equal each of them, (m,)."""
    # A sum of products stands for a row; that equal sums are of equal rows is checked.
    keys = rows @ np.random.default_rng(0).integers(-MOST, MOST, rows.shape[1])
    _, first, same = np.unique(keys, return_index=True, return_inverse=True)
    if not (rows[first[same]] == rows).all():
        _, first, same = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    return first[same]


def _line(numbers):
    """The number on the line of text before binary data."""
    text, _, _ = numbers.data[:32].partition(b"\n")
    if not text.strip().isdigit():
        raise numbers.wrong(f"must begin with a number: {text!r}")
    numbers.position = len(text) + 1
    return int(text)


def _read_4(numbers, names, has_entities):
    """Blocks of version 4.1, in which the entity of an element determines its groups."""
    groups = _groups_of_entities(numbers("Entities")) if has_entities else {}
    source, elements = numbers("Nodes"), _Elements(names)
    ids, points = [np.empty(0, dtype=np.int64)], [np.empty((0, 3))]
    n_blocks, n_nodes, _, _ = source.take(4, "size")
    for _ in range(n_blocks):
        dimension, _, parametric = source.take(3)
        (count,) = source.take(1, "size")
        ids.append(source.take(count, "size"))
        width = 3 + (dimension if parametric else 0)
        points.append(source.take(width * count, "f8").reshape(count, width)[:, :3])
    source.end(sum(map(len, ids)), n_nodes, "nodes")
    source, n_found = numbers("Elements", "i8"), 0
    n_blocks, n_elements, _, _ = source.take(4, "size")
    for _ in range(n_blocks):
        dimension, entity, number = source.take(3)
        (count,) = source.take(1, "size")
        kind = source.kind(int(number))
        table = source.take(count * (1 + kind[2]), "size").reshape(count, 1 + kind[2])
        tags = groups.get((int(dimension), int(entity)), ())
        elements.add(kind, table[:, 0], table[:, 1:], tags)
        n_found += count
    source.end(n_found, n_elements, "elements")
    return elements.mesh(np.concatenate(ids), np.concatenate(points))


def _groups_of_entities(source):
    """(dimension, entity) -> tags of its physical groups; negative if orientation is reversed."""
    groups = {}
    for dimension, count in enumerate(source.take(4, "size")):
        for _ in range(count):
            (entity,) = source.take(1)
            source.take(6 if dimension else 3, "f8")
            groups[dimension, int(entity)] = source.take(source.take(1, "size")[0])
            if dimension:
                source.take(source.take(1, "size")[0])
    return groups
