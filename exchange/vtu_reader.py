"""Reads VTK's unstructured grids (.vtu): every version, encoding and compressor.

Neither meshio nor VTK reads them here: meshio knows versions to 1.0, no voxels, no lz4; VTK 9.1
aborts or hangs on some damaged files, and its package conflicts with Debian's ParaView.
"""

import base64
import lzma
import re
import zlib
from xml.etree import ElementTree

import numpy as np

from common.errors import InputError
from exchange.foreign_mesh import as_numbers, content, fitting

KINDS = {"Int": "i", "UInt": "u", "Float": "f"}
APPENDED = re.compile(rb"<AppendedData([^>]*)>\s*_")


class Grid:
    """points (n, 3), offsets (m,) of the ends of cells in connectivity (k,), types (m,) of cells,
    and the arrays of points and of cells by name."""

    def __init__(self, path):
        """Reads a file. Raises InputError."""
        self.path, data = path, content(path)
        found = APPENDED.search(data)
        self.appended, self.raw = b"", False
        if found:
            end = data.rfind(b"</AppendedData>")
            self.raw = b"base64" not in found[1]
            self.appended = data[found.end() : end if end >= 0 else len(data)]
            if end < 0:
                raise self.wrong("has no end: </AppendedData> is missing, it is cut off")
            data = data[: found.end()] + data[end:]
        try:
            root = ElementTree.fromstring(data)
        except (ElementTree.ParseError, ValueError, LookupError) as error:
            raise self.wrong(f"its XML is cut off or damaged: {error}") from error
        # Lines of arrays, for messages: the parser does not keep them.
        starts = [
            data.count(b"\n", 0, at.start()) + 1 for at in re.finditer(rb"<DataArray\b", data)
        ]
        self.lines = dict(zip(root.iter("DataArray"), starts))
        grid = root.find("UnstructuredGrid")
        if root.tag != "VTKFile" or grid is None:
            kind = root.get("type", root.tag)
            raise self.wrong(f"it is of type {kind}; UnstructuredGrid is required")
        order = root.get("byte_order", "LittleEndian")
        if order not in ("LittleEndian", "BigEndian"):
            raise self.wrong(f"byte_order='{order}'; LittleEndian or BigEndian is required")
        self.order = "<" if order == "LittleEndian" else ">"
        self.header = self.kind(root.get("header_type", "UInt32"))
        self.decompress = self.decompressor(root.get("compressor", ""))
        pieces = grid.findall("Piece")
        if len(pieces) != 1:
            raise InputError(f"{path}: has {len(pieces)} pieces; one is required")
        self.read(pieces[0])

    def wrong(self, reason, element=None):
        """The InputError of this reason, with the line of an array."""
        line = f":{self.lines[element]}" if element is not None else ""
        return InputError(f"{self.path}{line}: cannot be read as a .vtu grid: {reason}")

    def read(self, piece):
        """Reads the arrays of the only piece."""
        try:
            n_points, n_cells = (int(piece.get("NumberOf" + n)) for n in ("Points", "Cells"))
        except (TypeError, ValueError):
            raise self.wrong("<Piece> needs NumberOfPoints and NumberOfCells") from None
        points, cells = self.arrays(piece, "Points", n_points), self.arrays(piece, "Cells", None)
        for name in ("connectivity", "offsets", "types"):
            if cells.get(name, np.empty(0, "f")).dtype.kind == "f":
                raise self.wrong(f"<Cells> needs an integer array '{name}'")
            setattr(self, name, cells[name])
        if len(points) != 1 or next(iter(points.values())).shape != (n_points, 3):
            raise self.wrong(f"<Points> needs one array of {n_points} points, of 3 components")
        self.points = next(iter(points.values())).astype(float)
        self.check(n_cells)
        self.point_data = self.arrays(piece, "PointData", n_points)
        self.cell_data = self.arrays(piece, "CellData", n_cells)

    def check(self, n_cells):
        """Raises InputError unless the cells are consistent."""
        self.connectivity, self.offsets, self.types = (
            values.astype(np.int64).ravel()
            for values in (self.connectivity, self.offsets, self.types)
        )
        if len(self.offsets) != n_cells or len(self.types) != n_cells:
            raise self.wrong(
                f"{len(self.offsets)} cells and {len(self.types)} types; {n_cells} are required"
            )
        sizes = np.diff(self.offsets, prepend=0)
        if (sizes < 0).any() or sizes.sum() != len(self.connectivity):
            raise self.wrong("offsets must increase to the length of connectivity")

    def arrays(self, piece, section, rows):
        """name -> array (rows,) or (rows, components) of a section; any rows if None."""
        found = {}
        for at, element in enumerate(piece.iterfind(f"{section}/DataArray")):
            name = element.get("Name", f"{section} {at}")
            if element.get("type") == "String":
                continue
            if name in found:
                raise self.wrong(f"two arrays of <{section}> are named '{name}'", element)
            try:
                width = int(element.get("NumberOfComponents", "1"))
            except ValueError:
                width = 0
            if width < 0:
                rule = "NumberOfComponents must be a whole number"
                raise self.wrong(f"array '{name}': {rule}", element)
            values = self.values(element, name)
            if width > 1 and len(values) % width == 0:
                values = values.reshape(-1, width)
            if rows is not None and len(values) != rows:
                rule = f"has {len(values)} rows; {rows} are required"
                raise self.wrong(f"array '{name}' {rule}", element)
            found[name] = values
        return found

    def kind(self, name):
        """NumPy's type of VTK's."""
        parts = re.fullmatch(r"(U?Int|Float)(8|16|32|64)", name)
        if not parts or name in ("Float8", "Float16"):
            raise self.wrong(f"type {name} is unknown")
        return np.dtype(f"{self.order}{KINDS[parts[1]]}{int(parts[2]) // 8}")

    def decompressor(self, name):
        """The function of (bytes, size) that a compressor needs, or None."""
        if name == "vtkZLibDataCompressor":
            return lambda data, size: zlib.decompress(data)
        if name == "vtkLZMADataCompressor":
            return lambda data, size: lzma.decompress(data)
        if name == "vtkLZ4DataCompressor":
            try:
                import lz4.block
            except ImportError:
                raise InputError(
                    f"{self.path}: is compressed with lz4, which needs package python3-lz4; or "
                    "save it with zlib, or uncompressed"
                ) from None
            return lambda data, size: lz4.block.decompress(data, uncompressed_size=size)
        if name:
            raise self.wrong(f"compressor {name} is unknown; zlib, lzma and lz4 are read")
        return None

    def values(self, element, name):
        """The numbers of a DataArray, one after the other."""
        kind, form = self.kind(element.get("type", "")), element.get("format", "ascii")
        # VTK puts its own remarks, such as ranges, into elements beside the numbers.
        text = (element.text or "") + "".join(child.tail or "" for child in element)
        try:
            if form == "ascii":
                found = as_numbers(text, "f8" if kind.kind == "f" else "i8")
                return found if kind.kind == "f" else fitting(found, kind.newbyteorder("="))
            if form == "binary":
                data, raw = "".join(text.split()).encode("ascii"), False
            elif form == "appended":
                offset = int(element.get("offset", ""))
                if not 0 <= offset < len(self.appended):
                    raise ValueError(f"its offset {offset} is outside of the appended data")
                data, raw = memoryview(self.appended)[offset:], self.raw
            else:
                raise ValueError(f"its format '{form}' is none of ascii, binary and appended")
            return np.frombuffer(self.bytes(data, raw), kind).astype(kind.newbyteorder("="))
        except Exception as error:  # a library may fail in any way on damaged data
            if isinstance(error, MemoryError):
                raise
            raise self.wrong(f"array '{name}': {error}", element) from error

    def bytes(self, data, raw):
        """The bytes of an array: a header of sizes, and what it announces."""

        def take(start, count):
            """(bytes, where they end); start and end count characters of `data`."""
            length = count if raw else -(-count // 3) * 4
            piece = bytes(data[start : start + length])
            piece = piece if raw else base64.b64decode(piece, validate=True)
            if len(piece) < count:
                raise ValueError("it is cut off")
            return piece[:count], start + length

        word = self.header.itemsize
        if self.decompress is None:
            # Size and content are encoded together, elsewhere a header of its own comes first.
            (size,) = np.frombuffer(take(0, word)[0], self.header).tolist()
            return take(0, word + size)[0][word:]
        blocks, whole, last = np.frombuffer(take(0, 3 * word)[0], self.header).tolist()
        if blocks * word > len(data) or whole >= 2**31:
            raise ValueError(f"it speaks of {blocks} blocks of {whole} bytes, more than it holds")
        head, at = take(0, (3 + blocks) * word)
        sizes = np.frombuffer(head, self.header)[3:].tolist()
        packed, _ = take(at, sum(sizes))
        found, at = [], 0
        for i, size in enumerate(sizes):
            wanted = last if last and i == blocks - 1 else whole
            found.append(self.decompress(packed[at : at + size], wanted))
            if len(found[-1]) != wanted:
                raise ValueError(f"block {i} has {len(found[-1])} bytes; {wanted} are required")
            at += size
        return b"".join(found)
