"""Reads VTK's legacy files (.vtk) of unstructured grids: ASCII and binary, versions 1.0 to 5.1.

meshio refuses normals, colours and version 5.0, and takes damaged files for whole ones.
"""

import re
from urllib.parse import unquote

import numpy as np

from common.errors import InputError
from exchange.foreign_mesh import NotNumber, as_numbers, content, fitting, word_starts
from exchange.vtu_reader import Grid

TYPES = {"bit": "b", "char": "i1", "short": "i2", "int": "i4", "long": "i8", "float": "f4"}
TYPES |= {"unsigned_" + name: TYPES[name].replace("i", "u") for name in list(TYPES)[1:5]}
TYPES |= {f"vtktype{u}int{8 * n}": f"{u or 'i'}{n}" for u in ("", "u") for n in (1, 2, 4, 8)}
TYPES |= {"double": "f8", "vtkidtype": "i4"}
# Components of the attributes that a line of name and type announces.
ATTRIBUTES = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "TENSORS6": 6}
ATTRIBUTES |= {"GLOBAL_IDS": 1, "PEDIGREE_IDS": 1, "EDGE_FLAGS": 1}


class LegacyGrid(Grid):
    """As Grid, of a legacy file."""

    def __init__(self, path):
        """Reads a file. Raises InputError."""
        self.path, self.data, self.position, self.section = path, content(path), 0, 0
        version = re.match(r"# vtk DataFile Version +\d+\.\d+\s*$", self.line())
        self.line()  # the title
        form = self.line().upper()
        if not version or form not in ("ASCII", "BINARY"):
            self.section = 0
            raise self.wrong(
                "'# vtk DataFile Version N', a title, and ASCII or BINARY must come first"
            )
        self.binary = form == "BINARY"
        self.point_data, self.cell_data, self.into, self.rows = {}, {}, {}, None
        self.starts = self.points = self.offsets = self.connectivity = self.types = None
        while words := self.words():
            read = getattr(self, "read_" + words[0].lower(), None)
            try:
                if read:
                    read(*words[1:])
                elif words[0].upper() in ATTRIBUTES:
                    self.keep(words[1], ATTRIBUTES[words[0].upper()], words[2])
                else:
                    word = (
                        words[0][:40] if words[0].isascii() and words[0].isprintable() else "data"
                    )
                    rule = "the array before is longer than announced, or damaged"
                    raise self.wrong(f"{word!r} stands where a keyword is required: {rule}")
            except (TypeError, ValueError, IndexError):  # too few words, or other than numbers
                raise self.wrong(f"'{' '.join(words)[:60]}' is incomplete or damaged") from None
        for name, found in (("POINTS", self.points), ("CELLS", self.offsets)):
            if found is None:
                raise self.wrong(f"section {name} is missing")
        if self.types is None:
            raise self.wrong("section CELL_TYPES is missing")
        self.check(len(self.types))
        for name, data, rows in (
            ("POINT_DATA", self.point_data, len(self.points)),
            ("CELL_DATA", self.cell_data, len(self.types)),
        ):
            if any(len(values) != rows for values in data.values()):
                raise self.wrong(f"{name} must have {rows} rows")

    def wrong(self, reason):
        """The InputError of this reason, with the line of the section."""
        line = self.data.count(b"\n", 0, self.section) + 1
        return InputError(f"{self.path}:{line}: cannot be read as a .vtk grid: {reason}")

    def line(self):
        """The next line, stripped; "" at the end of the file."""
        end = self.data.find(b"\n", self.position)
        end = len(self.data) if end < 0 else end
        self.section = self.position
        self.position = min(end + 1, len(self.data))
        return self.data[self.section : end].decode("utf-8", "replace").strip()

    def words(self):
        """The words of the next line that is not empty; none at the end of the file."""
        while self.position < len(self.data):
            if words := self.line().split():
                return words
        return []

    def follows(self, word):
        """The words of the next line if it begins with `word`; else none, and it is not taken."""
        position, section = self.position, self.section
        words = self.words()
        if words and words[0].upper() == word:
            return words
        self.position, self.section = position, section
        return []

    def numbers(self, count, kind):
        """The next numbers (count,) of a type by its name in the file."""
        if kind.lower() not in TYPES:
            raise self.wrong(
                f"type {kind[:40]!r} is unknown or not supported; numbers are required"
            )
        kind, count = TYPES[kind.lower()], int(count)
        if not 0 <= count <= 8 * len(self.data):
            raise self.wrong(f"{count} numbers are announced, more than the file holds")
        if self.binary:
            size = -(-count // 8) if kind == "b" else count * int(kind[1])
            piece = self.data[self.position : self.position + size]
            if len(piece) < size:
                raise self.wrong(f"{count} numbers are announced, more than follow: it is cut off")
            self.position += size
            self.position += len(
                re.match(rb"\r?\n?", self.data[self.position : self.position + 2])[0]
            )
            if kind == "b":
                return np.unpackbits(np.frombuffer(piece, "u1"))[:count]
            return np.frombuffer(piece, ">" + kind).astype(kind)
        if self.starts is None:
            self.starts = np.append(word_starts(self.data), len(self.data))
        first = int(np.searchsorted(self.starts, self.position))
        if first + count >= len(self.starts):
            follow = len(self.starts) - 1 - first
            raise self.wrong(f"{count} numbers are announced, {follow} follow: it is cut off")
        text = self.data[self.position : self.starts[first + count]]
        self.position = int(self.starts[first + count])
        try:
            values = as_numbers(text, "f8" if kind[0] == "f" else "i8")
            return values if kind[0] == "f" else fitting(values, "u1" if kind == "b" else kind)
        except NotNumber as error:
            raise self.wrong(f"{count} numbers are announced, but {error}") from error

    def keep(self, name, width, kind, rows=None):
        """Reads an array of points or of cells, or one that belongs to neither."""
        width, name = int(width), unquote(name)
        if rows is None and self.rows is None:
            raise self.wrong(f"array '{name}' comes before POINT_DATA and CELL_DATA")
        rows = int(self.rows if rows is None else rows)
        values = self.numbers(rows * width, kind)
        if name in self.into:
            raise self.wrong(f"two arrays are named '{name}'")
        self.into[name] = values if width == 1 else values.reshape(rows, width)

    def first(self, found):
        """Raises InputError if a section was read already."""
        if found is not None:
            raise self.wrong("a grid has one section of this kind")

    def read_dataset(self, kind):
        if kind.upper() != "UNSTRUCTURED_GRID":
            raise self.wrong(f"it is of type {kind}; UNSTRUCTURED_GRID is required")

    def read_points(self, count, kind):
        self.first(self.points)
        self.points = self.numbers(3 * int(count), kind).astype(float).reshape(-1, 3)

    def read_cells(self, count, size):
        self.first(self.offsets)
        if words := self.follows("OFFSETS"):  # since version 5.0
            ends = self.numbers(count, words[1])
            if not (words := self.follows("CONNECTIVITY")) or not len(ends) or ends[0] != 0:
                raise self.wrong("OFFSETS from 0 and CONNECTIVITY are required after CELLS")
            self.offsets, self.connectivity = ends[1:], self.numbers(size, words[1])
            return
        count, table = int(count), self.numbers(size, "int")
        starts = [0]
        while len(starts) <= count:
            starts.append(starts[-1] + 1 + int(table[starts[-1]]))
            if starts[-1] <= starts[-2]:
                raise self.wrong("a cell has a negative number of nodes")
        if starts[-1] != len(table):
            raise self.wrong(f"{count} cells have {starts[-1]} numbers; {len(table)} are announced")
        self.offsets = np.array(starts[1:]) - np.arange(1, count + 1)
        self.connectivity = np.delete(table, starts[:-1])

    def read_cell_types(self, count):
        self.first(self.types)
        self.types = self.numbers(count, "int")

    def read_point_data(self, count):
        self.into, self.rows = self.point_data, int(count)

    def read_cell_data(self, count):
        self.into, self.rows = self.cell_data, int(count)

    def read_scalars(self, name, kind, width=1):
        self.follows("LOOKUP_TABLE")
        self.keep(name, width, kind)

    def read_color_scalars(self, name, width):
        self.keep(name, width, "unsigned_char" if self.binary else "float")

    def read_lookup_table(self, name, count):
        self.numbers(4 * int(count), "unsigned_char" if self.binary else "float")

    def read_texture_coordinates(self, name, width, kind):
        self.keep(name, width, kind)

    def read_field(self, name, count):
        own, self.into = self.into, {} if self.rows is None else self.into
        for _ in range(int(count)):
            name, width, rows, kind = self.words()
            self.keep(name, width, kind, rows)
            self.follows("METADATA") and self.read_metadata()
        self.into = own

    def read_metadata(self):
        """Skips remarks up to an empty line."""
        while self.position < len(self.data) and self.line():
            pass
