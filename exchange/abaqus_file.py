"""Reads and writes Abaqus and CalculiX input files (.inp): the mesh and its sets.

meshio is not used: it ends a list of nodes at a comment, lets a second *NODE, or a second *NSET of
the same name, replace the first, drops sets made of sets, mixes up the blocks of element sets, and
rejects lower-case types.
"""

import re

import numpy as np

from common.errors import InputError
from exchange.foreign_mesh import HEXAHEDRON, Block, ForeignMesh

GENERATING = ("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM")
VOLUME = re.compile(r"(A?C|D?C|Q|G|GK|COH|E)3D\d|SC[68]R|CSS8|C3D")
BRICK = re.compile(r"C3D8[A-Z]*")


def read(path):
    """The ForeignMesh of an .inp file: all sets become node sets, sets of elements also element
    sets.

    As in Abaqus, names of sets are not case-sensitive; the first spelling is kept. Raises
    InputError naming the line.
    """
    reader = _Reader()
    reader.read(path, 0)
    return reader.mesh(path)


class _Sets:
    """Sets of numbers by name; several keywords may contribute to the same set."""

    def __init__(self):
        self.spelled, self.members = {}, {}

    def add(self, name, numbers):
        """Adds numbers to the set of this name."""
        self.spelled.setdefault(name.upper(), name)
        self.members.setdefault(name.upper(), set()).update(numbers)


class _Reader:
    def __init__(self):
        self.ids, self.points, self.blocks = [], [], []
        self.nodes, self.elements = _Sets(), _Sets()
        self.instances = 0

    def read(self, path, depth):
        """Reads all keywords of a file and of the files it includes. Raises InputError."""
        try:
            text = path.read_text(encoding="utf-8", errors="replace")
        except OSError as error:
            raise InputError(f"{path}: cannot be read: {error.strerror}") from error
        for keyword, options, lines, where in _keywords(path, text):
            if keyword == "INCLUDE":
                if depth > 9 or not options.get("INPUT"):
                    raise InputError(f"{where}: *INCLUDE needs INPUT=FILE, nested at most ten deep")
                self.read(path.parent / options["INPUT"], depth + 1)
            elif keyword in GENERATING:
                raise InputError(
                    f"{where}: *{keyword} is not supported; write all nodes and elements"
                )
            elif keyword == "INSTANCE":
                self.instances += 1
                if self.instances > 1 or lines:
                    raise InputError(
                        f"{where}: *INSTANCE: only one is allowed, neither translated nor rotated"
                    )
            elif keyword == "NODE":
                self._read_nodes(options, lines, where)
            elif keyword == "ELEMENT":
                self._read_elements(options, lines, where)
            elif keyword in ("NSET", "ELSET"):
                self._read_set(keyword, options, lines, where)

    def _read_nodes(self, options, lines, where):
        if options.get("SYSTEM", "R").upper() != "R":
            raise InputError(f"{where}: *NODE, SYSTEM: rectangular coordinates are required")
        for place, fields in lines:
            if not 3 <= len(fields) <= 7:
                raise InputError(f"{place}: a node needs an id and three coordinates")
            self.ids.append(_whole(place, fields[0]))
            xyz = [_real(place, field) for field in fields[1:4]]
            self.points.append(xyz + [0.0] * (3 - len(xyz)))
        if name := options.get("NSET"):
            self.nodes.add(name, self.ids[len(self.ids) - len(lines) :])

    def _read_elements(self, options, lines, where):
        kind = options.get("TYPE", "").upper()
        if not kind:
            raise InputError(f"{where}: *ELEMENT needs TYPE=")
        if BRICK.fullmatch(kind):
            numbers = [_whole(place, field) for place, fields in lines for field in fields if field]
            if len(numbers) % 9:
                raise InputError(f"{where}: {kind} needs an id and eight nodes for each element")
            rows = np.array(numbers, dtype=np.int64).reshape(-1, 9)
            self._add(Block(HEXAHEDRON, 3, rows[:, 0], rows[:, 1:]), options)
            return
        elements, alike = [[]], {}
        for place, fields in lines:
            elements[-1] += [_whole(place, field) for field in fields if field]
            if fields[-1]:  # a line that ends with a comma is continued
                elements.append([])
        for element in filter(None, elements):
            alike.setdefault(len(element), []).append(element)
        for rows in alike.values():
            table = np.array(rows, dtype=np.int64)
            dimension = 3 if VOLUME.match(kind) else 2
            self._add(Block(kind, dimension, table[:, 0], table[:, 1:]), options)

    def _add(self, block, options):
        self.blocks.append(block)
        if name := options.get("ELSET"):
            self.elements.add(name, block.ids.tolist())

    def _read_set(self, keyword, options, lines, where):
        own = self.nodes if keyword == "NSET" else self.elements
        name = options.get(keyword)
        if not name:
            raise InputError(f"{where}: *{keyword} needs a name: {keyword}=NAME")
        own.add(name, ())
        if keyword == "NSET" and options.get("ELSET"):
            own.add(name, self._nodes_of(self._members(where, self.elements, options["ELSET"])))
        for place, fields in lines:
            fields = [field for field in fields if field]
            if "GENERATE" in options:
                ends = [_whole(place, field) for field in fields]
                step = ends[2] if len(ends) == 3 else 1
                if not 2 <= len(ends) <= 3 or step < 1 or ends[1] < ends[0]:
                    raise InputError(f"{place}: GENERATE needs first, last, and a positive step")
                if (ends[1] - ends[0]) // step >= 10**8:
                    raise InputError(f"{place}: GENERATE gives more than 100 million numbers")
                own.add(name, range(ends[0], ends[1] + 1, step))
                continue
            for field in fields:
                known = field.upper() in own.members and not field.lstrip("+-").isdigit()
                own.add(name, own.members[field.upper()] if known else [_whole(place, field)])

    def _members(self, where, sets, name):
        if name.upper() not in sets.members:
            raise InputError(f"{where}: set '{name}' must be defined before its use")
        return sets.members[name.upper()]

    def _nodes_of(self, elements):
        chosen = np.fromiter(elements, dtype=np.int64)
        found = [b.nodes[np.isin(b.ids, chosen)].ravel() for b in self.blocks]
        return np.unique(np.concatenate([np.empty(0, dtype=np.int64), *found])).tolist()

    def mesh(self, path):
        """The ForeignMesh. Raises InputError if a set names an element that does not exist."""
        sets, element_sets = {}, {}
        known = np.concatenate([np.empty(0, dtype=np.int64), *(b.ids for b in self.blocks)])
        for key, members in self.elements.members.items():
            missing = np.setdiff1d(np.fromiter(members, dtype=np.int64), known)
            if missing.size:
                name = self.elements.spelled[key]
                raise InputError(
                    f"{path}: set '{name}' names element {missing[0]}, which does not exist"
                )
            spelled = self.elements.spelled[key]
            element_sets[spelled] = np.array(sorted(members), dtype=np.int64)
            if key not in self.nodes.members:  # a node set of the same name takes precedence
                sets[spelled] = np.array(self._nodes_of(members), dtype=np.int64)
        for key, members in self.nodes.members.items():
            sets[self.nodes.spelled[key]] = np.array(sorted(members), dtype=np.int64)
        blocks, points = _joined(self.blocks), np.array(self.points).reshape(-1, 3)
        ids = np.array(self.ids, dtype=np.int64)
        return ForeignMesh(ids, points, blocks, sets, element_sets=element_sets)


def _joined(blocks):
    """The blocks; blocks of the same kind and width are joined."""
    alike = {}
    for block in blocks:
        alike.setdefault((block.kind, block.dimension, block.nodes.shape[1]), []).append(block)
    return [
        Block(
            kind,
            dimension,
            np.concatenate([b.ids for b in some]),
            np.concatenate([b.nodes for b in some]),
        )
        for (kind, dimension, _), some in alike.items()
    ]


def _keywords(path, text):
    """Yields (keyword, options, data lines, place); a data line is (place, fields)."""
    current, lines = None, []
    for number, line in enumerate(text.splitlines(), start=1):
        place, line = f"{path}:{number}", line.strip()
        if not line or line.startswith("**"):
            continue
        if not line.startswith("*"):
            if current is None:
                raise InputError(f"{place}: {line[:40]!r} comes before the first *KEYWORD")
            if not lines and current[0].endswith(",") and line[0].isalpha():
                current = (current[0] + line, current[1])  # the keyword's line is continued
                continue
            lines.append((place, [field.strip() for field in line.split(",")]))
            continue
        if current is not None:
            yield *_parsed(current[0]), lines, current[1]
        current, lines = (line, place), []
    if current is not None:
        yield *_parsed(current[0]), lines, current[1]


def _parsed(line):
    """The keyword of a line in capitals, and its options; names keep their case."""
    words = re.findall(r'(?:[^,"]|"[^"]*")+', line[1:])
    options = {}
    for word in words[1:]:
        key, _, value = word.partition("=")
        options[key.strip().upper()] = value.strip().strip('"')
    return " ".join(words[0].upper().split()) if words else "", options


def _whole(place, text):
    try:
        number = int(text)
        if abs(number) < 2**63:
            return number
    except ValueError:
        pass
    raise InputError(f"{place}: {text!r} must be a whole number")


def _real(place, text):
    try:
        return float(text.upper().replace("D", "E")) if text else 0.0
    except ValueError:
        raise InputError(f"{place}: {text!r} must be a number") from None


def number(value):
    """A number in at most 20 characters (longer ones are not read), exact if possible."""
    texts = (repr(float(value)), f"{value:.13e}", f"{value:.12e}")
    return next(text for text in texts if len(text) <= 20)


def mesh_lines(mesh, element="C3D8", element_set=None):
    """The lines of *NODE, *ELEMENT, *NSET and *ELSET of a HexMesh; ids count from one.

    element: an eight-node brick type. element_set: name of a set of all elements, or None.
    Raises InputError for a set name that the format does not allow.
    """
    lines = ["*NODE"]
    lines += [f"{i}, " + ", ".join(map(number, point)) for i, point in enumerate(mesh.points, 1)]
    # VTK and Abaqus number the vertices of a brick in the same order.
    lines.append(f"*ELEMENT, TYPE={element}" + (f", ELSET={element_set}" if element_set else ""))
    lines += [f"{i}, " + ", ".join(map(str, cell)) for i, cell in enumerate(mesh.cells + 1, 1)]
    lines += _set_lines("NSET", mesh.sets) + _set_lines("ELSET", mesh.element_sets)
    return lines


def _set_lines(keyword, sets):
    """The lines of sets, which count from zero. Raises InputError for a name."""
    lines, spelled = [], {}
    for name, members in sets.items():
        if not name.isprintable() or '"' in name or len(name) > 80:
            raise InputError(
                f"set {name!r}: names in .inp must be printable, without quotes, at most 80 "
                "characters"
            )
        other = spelled.setdefault(name.upper(), name)
        if other != name:
            raise InputError(f"sets '{other}' and '{name}': names in .inp are not case-sensitive")
        plain = re.fullmatch(r"[A-Za-z]\w*", name, re.ASCII)
        lines.append(f"*{keyword}, {keyword}=" + (name if plain else f'"{name}"'))
        ids = [str(member + 1) for member in members]
        lines += [", ".join(ids[at : at + 16]) for at in range(0, len(ids), 16)]
    return lines
