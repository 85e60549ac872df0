"""Writers of VTK's files, .vtu and legacy .vtk; version and encoding are drawn by chance."""

import base64
import io
import lzma
import zlib

import numpy as np
from bodies import BODY

from common.hexahedron import LEXICOGRAPHIC


def packer(compressor):
    """The function that compresses bytes."""
    if compressor == "LZ4":
        from lz4.block import compress

        return lambda data: compress(data, store_size=False)
    return {"ZLib": zlib.compress, "LZMA": lzma.compress}.get(compressor)


def vtu(rng, cell=12):
    """A .vtu file of any version, encoding and compressor."""
    form = str(rng.choice(["ascii", "binary", "raw", "base64"]))
    compressor = "" if form == "ascii" else str(rng.choice(["", "ZLib", "LZMA", "LZ4"]))
    version, pack = str(rng.choice(["0.1", "1.0", "2.0", "2.1", "2.2", "2.3"])), packer(compressor)
    big, wide = rng.random(2) < 0.5
    order, head = (">" if big else "<"), ("u8" if wide else "u4")
    appended = b""

    def array(name, values, width=1):
        nonlocal appended
        kind = values.dtype.str[1:]
        word = {"f4": "Float32", "f8": "Float64", "i4": "Int32", "i8": "Int64", "u1": "UInt8"}[kind]
        begin = f'<DataArray type="{word}" Name="{name}" NumberOfComponents="{width}" '
        if form == "ascii":
            inner = " ".join(repr(v) for v in values.ravel().tolist())
            return f'{begin}format="ascii">\n{inner}\n</DataArray>\n'
        data = values.astype(order + kind).tobytes()
        if pack:
            size = int(rng.integers(50, 400))
            parts = [data[i : i + size] for i in range(0, len(data), size)]
            packed = [pack(part) for part in parts]
            last = len(parts[-1]) % size
            header = np.array([len(parts), size, last, *map(len, packed)], order + head).tobytes()
            data = b"".join(packed)
        else:
            header = np.array(len(data), order + head).tobytes()
        if form == "raw":
            data = header + data
        elif pack:
            data = base64.b64encode(header) + base64.b64encode(data)
        else:
            data = base64.b64encode(header + data)
        if form == "binary":
            return f'{begin}format="binary">\n{data.decode()}\n</DataArray>\n'
        appended += data
        return f'{begin}format="appended" offset="{len(appended) - len(data)}"/>\n'

    points, cells = BODY.points.astype(rng.choice(["f4", "f8"])), BODY.cells
    cells = cells[:, LEXICOGRAPHIC] if cell == 11 else cells
    parts = ["".join(array(n, m) for n, m in some.items()) for some in BODY.marks("i4")]
    text = '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" '
    text += f'version="{version}" byte_order="{"Big" if big else "Little"}Endian" '
    text += f'header_type="UInt{64 if wide else 32}"'
    text += f' compressor="vtk{compressor}DataCompressor"' if pack else ""
    text += f'>\n<UnstructuredGrid>\n<Piece NumberOfPoints="{len(points)}" '
    text += f'NumberOfCells="{len(cells)}">\n<PointData>\n{parts[0]}</PointData>\n'
    text += f"<CellData>\n{parts[1]}</CellData>\n<Points>\n{array('Points', points, 3)}</Points>\n"
    text += "<Cells>\n" + array("connectivity", cells.astype("i8"))
    text += array("offsets", np.arange(8, 8 * len(cells) + 1, 8))
    text += array("types", np.full(len(cells), cell, "u1"))
    text += "</Cells>\n</Piece>\n</UnstructuredGrid>\n"
    if appended:
        kind = "raw" if form == "raw" else "base64"
        text += f'<AppendedData encoding="{kind}">\n_'
        return text.encode() + appended + b"\n</AppendedData>\n</VTKFile>\n"
    return (text + "</VTKFile>\n").encode()


def vtk(rng, binary, cell=12, dataset="UNSTRUCTURED_GRID"):
    """A legacy .vtk file of any version, its sets as scalars or in a field, among other arrays."""
    version = str(rng.choice(["2.0", "3.0", "4.0", "4.2", "5.0", "5.1"]))
    end = "\n" if binary else str(rng.choice(["\n", "\r\n"]))
    out = io.BytesIO()

    def text(*lines):
        out.write("".join(line + end for line in lines).encode())

    def put(values, kind):
        if binary:
            out.write(values.astype(">" + kind).tobytes() + b"\n")
            return
        words = [repr(v) for v in values.ravel().tolist()]
        wide = int(rng.integers(1, 12))
        text(*(" ".join(words[i : i + wide]) for i in range(0, len(words), wide)))

    kinds = {"f4": "float", "f8": "double", "i4": "int", "u1": "unsigned_char", "i2": "short"}
    real = str(rng.choice(["f4", "f8"]))
    cells = BODY.cells[:, LEXICOGRAPHIC] if cell == 11 else BODY.cells
    text(f"# vtk DataFile Version {version}", "a body", "BINARY" if binary else "ASCII")
    text(f"DATASET {dataset}")
    if rng.random() < 0.5:
        text("FIELD FieldData 1", "TIME 1 1 double")
        put(np.array([0.5]), "f8")
    text(f"POINTS {len(BODY.points)} {kinds[real]}")
    put(BODY.points.astype(real), real)
    if version[0] == "5":
        text("", f"CELLS {len(cells) + 1} {cells.size}", "OFFSETS vtktypeint64")
        put(np.arange(0, cells.size + 1, 8), "i8")
        text("CONNECTIVITY vtktypeint64")
        put(cells, "i8")
    else:
        text("", f"CELLS {len(cells)} {cells.size + len(cells)}")
        put(np.insert(cells, 0, 8, axis=1), "i4")
    text("", f"CELL_TYPES {len(cells)}")
    put(np.full(len(cells), cell), "i4")
    for word, arrays in zip(("POINT_DATA", "CELL_DATA"), BODY.marks("i8")):
        count = len(next(iter(arrays.values())))
        text("", f"{word} {count}")
        if rng.random() < 0.5:
            text("VECTORS speed float")
            put(rng.random((count, 3)).astype("f4"), "f4")
        if field := rng.random() < 0.5:
            text(f"FIELD FieldData {len(arrays)}")
        for name, marks in arrays.items():
            kind = str(rng.choice(["i4", "u1", "i2"]))
            if field:
                text(f"{name} 1 {count} {kinds[kind]}")
            else:
                text(f"SCALARS {name} {kinds[kind]}" + rng.choice(["", " 1"]), "LOOKUP_TABLE own")
            put(marks, kind)
            if version == "5.1":
                text("METADATA", "INFORMATION 0", "")
        if not field:
            text("LOOKUP_TABLE own 2")
            put(np.arange(8) / 8, "u1" if binary else "f4")
            text("NORMALS outward double")
            put(rng.random((count, 3)), "f8")
    return out.getvalue()
