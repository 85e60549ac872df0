"""Files of other programs that all hold the same body, and mutilated ones.

    /usr/bin/python3 exchange/tests/generated.py --count 300 --seed 1
    /usr/bin/python3 exchange/tests/generated.py --mutilate 5000 --seed 1

The body is a bent block of 2 x 2 x 3 hexahedra in two materials; a labelled image holds a block of
voxels. Numbering, order, line ends, spelling and encoding are drawn by chance. Read, a file must
give the body: its nodes, elements and sets, however numbered; or it must be refused as foreseen.
"""

import argparse
import base64
import io
import contextlib
import os
import struct
import sys
import tempfile
import zlib
from collections import Counter
from pathlib import Path

import h5py
import numpy as np

if __name__ == "__main__":
    sys.path[0] = str(Path(__file__).resolve().parents[2])
from exchange import convert  # noqa: E402

LAYERS = (2, 2, 3)


def grid(layers):
    """(whole-numbered points, cells) of a block, in the order of VTK."""
    n = np.array(layers) + 1
    points = np.stack(np.unravel_index(np.arange(n.prod()), n), axis=1)
    low = points[(points < layers).all(axis=1)]
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    corners += [(x, y, 1) for x, y, _ in corners]
    cells = [[np.ravel_multi_index(tuple(p + c), n) for c in corners] for p in low]
    return points, np.array(cells)


class Body:
    """points, cells, sets and element_sets, whose names every format can hold."""

    def __init__(self):
        at, self.cells = grid(LAYERS)
        x, y, z = (at * (0.05, 0.05, 0.1)).T
        self.points = np.column_stack([x + 0.8 * z * z, y - 0.3 * x * z, z + 0.2 * x])
        faces = {"foot": at[:, 2] == 0, "head": at[:, 2] == 3, "side": at[:, 0] == 0}
        self.sets = {name: np.flatnonzero(inside) for name, inside in faces.items()}
        layer = at[self.cells[:, 0], 2]
        self.element_sets = {"stiff": np.flatnonzero(layer == 1)}
        self.element_sets["soft"] = np.flatnonzero(layer != 1)

    def quads(self, name):
        """The faces (n, 4) of elements that lie in a set of nodes."""
        sides = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
        faces = self.cells[:, sides].reshape(-1, 4)
        return faces[np.isin(faces, self.sets[name]).all(axis=1)]


BODY = Body()
GROUPS = ["foot", "head", "side"]


def number(rng, count):
    """Numbers of nodes or elements, with gaps and in any order."""
    return rng.choice(np.arange(1, 5 * count), count, replace=False)


def gmsh(rng, version, binary, kind=5, partitioned=False):
    """A .msh file; kind is Gmsh's type of the volumes."""
    ids, order = number(rng, len(BODY.points)), rng.permutation(len(BODY.points))
    blocks = [(2, tag, 3, ids[BODY.quads(name)]) for tag, name in enumerate(GROUPS, 1)]
    for tag, name in ((1, "stiff"), (2, "soft")):
        blocks.append((3, tag, kind, ids[BODY.cells[BODY.element_sets[name]]]))
    blocks = [blocks[i] for i in rng.permutation(len(blocks))]
    if kind == 17:  # of second order
        blocks = [(d, t, k, np.tile(n, 3)[:, :20] if d == 3 else n) for d, t, k, n in blocks]
    names = [(2, tag, name) for tag, name in enumerate(GROUPS, 1)]
    names += [(3, 1, "stiff"), (3, 2, "soft")]
    out = io.BytesIO()

    def text(line):
        out.write(line.encode() + b"\n")

    def put(form, *values):
        if binary:
            out.write(struct.pack("<" + form, *values))
        else:
            text(" ".join(repr(v.item() if hasattr(v, "item") else v) for v in values))

    text(f"$MeshFormat\n{version} {int(binary)} 8")
    if binary:
        put("i", 1)
        text("")
    text(f"$EndMeshFormat\n$PhysicalNames\n{len(names)}")
    for d, tag, name in names:
        text(f'{d} {tag} "{name}"')
    text("$EndPhysicalNames")
    if partitioned:
        text("$PartitionedEntities\n0\n$EndPartitionedEntities")
    n_elements = sum(len(block[3]) for block in blocks)
    first = 1
    if version == "2.2":
        text(f"$Nodes\n{len(ids)}")
        for n in order:
            put("i3d", ids[n], *BODY.points[n])
        text(f"$EndNodes\n$Elements\n{n_elements}")
        for _, tag, form, nodes in blocks:
            if binary:
                put("3i", form, len(nodes), 2)
            for row in nodes:
                head = (first, tag, tag) if binary else (first, form, 2, tag, tag)
                put(f"{len(head) + len(row)}i", *head, *row)
                first += 1
        text("$EndElements")
        return out.getvalue()
    text("$Entities")
    put("4Q", 0, 0, 3, 2)
    for d, tag, _ in names:
        put("i6dQiQ", tag, *[0.0] * 6, 1, tag, 0)
    text("$EndEntities\n$Nodes")
    put("4Q", 1, len(ids), ids.min(), ids.max())
    put("3iQ", 3, 1, 0, len(ids))
    for n in order:
        put("Q", ids[n])
    for n in order:
        put("3d", *BODY.points[n])
    text("$EndNodes\n$Elements")
    put("4Q", len(blocks), n_elements, 1, n_elements)
    for d, tag, form, nodes in blocks:
        put("3iQ", d, tag, form, len(nodes))
        for row in nodes:
            put(f"{1 + len(row)}Q", first, *row)
            first += 1
    text("$EndElements")
    return out.getvalue()


def vtu(rng, form, compressor, version, big, wide, real, cell=12):
    """A .vtu file: form is ascii, binary, raw or base64 (appended)."""
    order, head = (">" if big else "<"), ("u8" if wide else "u4")
    cells = BODY.cells[:, [0, 1, 3, 2, 4, 5, 7, 6]] if cell == 11 else BODY.cells
    pack = {"ZLib": zlib.compress, "LZMA": __import__("lzma").compress}.get(compressor)
    if compressor == "LZ4":
        block = __import__("lz4.block").block
        pack = lambda data: block.compress(data, store_size=False)  # noqa: E731
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

    places = BODY.points.astype(real)
    ends = np.arange(8, 8 * len(cells) + 1, 8)
    masks = {name: np.isin(np.arange(len(places)), s) for name, s in BODY.sets.items()}
    marks = {name: np.isin(np.arange(len(cells)), s) for name, s in BODY.element_sets.items()}
    parts = ["".join(array(n, m.astype("i4")) for n, m in some.items()) for some in (masks, marks)]
    text = '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" '
    text += f'version="{version}" byte_order="{"Big" if big else "Little"}Endian" '
    text += f'header_type="UInt{64 if wide else 32}"'
    text += f' compressor="vtk{compressor}DataCompressor"' if pack else ""
    text += f'>\n<UnstructuredGrid>\n<Piece NumberOfPoints="{len(places)}" '
    text += f'NumberOfCells="{len(cells)}">\n<PointData>\n{parts[0]}</PointData>\n'
    text += f"<CellData>\n{parts[1]}</CellData>\n<Points>\n{array('Points', places, 3)}</Points>\n"
    text += "<Cells>\n" + array("connectivity", cells.astype("i8")) + array("offsets", ends)
    text += array("types", np.full(len(cells), cell, "u1"))
    text += "</Cells>\n</Piece>\n</UnstructuredGrid>\n"
    if appended:
        kind = "raw" if form == "raw" else "base64"
        text += f'<AppendedData encoding="{kind}">\n_'
        return text.encode() + appended + b"\n</AppendedData>\n</VTKFile>\n"
    return (text + "</VTKFile>\n").encode()


def inp(rng, parts, clash=False):
    """An .inp file: flat, or of parts as Abaqus/CAE writes them; with the same name in part and
    assembly if clash."""
    ids, numbers = number(rng, len(BODY.points)), number(rng, len(BODY.cells))
    comma = "," if rng.random() < 0.5 else ""
    move, axis, angle = rng.normal(size=3), rng.normal(size=3), rng.uniform(-180, 180)
    points = BODY.points
    if parts:  # where the instance's motion brings the body back to its place
        a, t = axis / np.linalg.norm(axis), -np.radians(angle)
        across = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
        turn = np.eye(3) + np.sin(t) * across + (1 - np.cos(t)) * across @ across
        points = points @ turn.T - move
    word = (str.upper, str.lower, str.title)[rng.integers(3)]
    body = [word("*node")]
    rows = rng.permutation(len(ids))
    body += [f"{ids[n]}, " + ", ".join(map(repr, points[n].tolist())) + comma for n in rows]
    body.append(word("*element") + ", type=C3D8R")
    for e in rng.permutation(len(numbers)):
        row = [numbers[e], *ids[BODY.cells[e]]]
        cut = int(rng.integers(4, 9))
        lines = [row] if rng.random() < 0.7 else [row[:cut], row[cut:]]
        body += [
            ", ".join(map(str, line)) + ("," if line is not lines[-1] else comma) for line in lines
        ]
    some = []
    instance = ", instance=Body-1" if parts else ""
    for kind, sets, of in (("nset", BODY.sets, ids), ("elset", BODY.element_sets, numbers)):
        for name, members in sets.items():
            some.append(f"{word('*' + kind)}, {kind}={name}{instance}")
            some += [
                ", ".join(map(str, of[members[i : i + 16]])) + comma
                for i in range(0, len(members), 16)
            ]
    late = [f"{word('*nset')}, nset=ends", "foot, head"]
    some = late + some if rng.random() < 0.5 else some + late
    if parts:
        every = ["*Nset, nset=Set-1, generate", f" 1, {ids.max()}, 1"]
        if clash:
            every[0] = "*Nset, nset=foot, generate"
        other = ["*Part, name=Unused", "*Node", "1, 0., 0., 0.", "*End Part"]
        place = ", ".join(map(repr, move.tolist()))
        turn = ", ".join(map(repr, [0.0, 0.0, 0.0, *axis.tolist(), float(angle)]))
        body = ["*Heading", "*Part, name=Body", *body, *every, "*End Part", *other]
        body += ["*Assembly, name=Assembly", "*Instance, name=Body-1, part=Body", place, turn]
        body += ["*End Instance", *some, "*End Assembly", "*Step", "*Static", "1., 1.", "*End Step"]
    else:
        body += some
    for _ in range(3):
        body.insert(int(rng.integers(1, len(body))), "** a comment, 1, 2")
    end = ("\n", "\r\n", "\r")[rng.integers(3)]
    return (b"\xef\xbb\xbf" if rng.random() < 0.3 else b"") + (end.join(body) + end).encode()


def nifti(rng, path):
    """A labelled image in any orientation, unit, type and scale; its mesh of voxels."""
    import nibabel

    labels = np.zeros((3, 4, 5), dtype=np.int16)
    labels[1:, :3, :4] = 1
    labels[2, 1, 1:3] = 7
    size, unit = rng.uniform(0.5, 3, 3), rng.choice(["mm", "meter", "micron", "unknown"])
    map_ = np.eye(3)[rng.permutation(3)] * rng.choice([-1, 1], 3) * size
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = map_, rng.normal(size=3)
    kind = rng.choice(["i2", "u1", "f4", "f8"])
    slope = rng.choice([1.0, 0.1, 0.3, 2.0])
    stored = labels / slope
    kept = labels if slope == 1 or kind[0] in "iu" else stored
    image = nibabel.Nifti1Image(kept.astype(kind), affine)
    image.header.set_xyzt_units(str(unit))
    image.set_sform(affine, int(rng.choice([1, 2])))
    if kept is stored:
        image.header.set_slope_inter(slope, 0)
    nibabel.save(image, path)
    if kept is stored:  # nibabel scales by itself: set what the header says of raw numbers
        data = bytearray(path.read_bytes())
        data[112:120] = struct.pack("<2f", slope, 0)
        path.write_bytes(data)
    metres = {"meter": 1.0, "micron": 1e-6}.get(unit, 1e-3)
    middles = (np.argwhere(labels) @ map_.T + affine[:3, 3]) * metres
    return {
        "middles": middles,
        "values": labels[labels > 0],
        "volume": np.prod(size) * metres**3,
    }


def versions(rng):
    return str(rng.choice(["0.1", "1.0", "2.0", "2.1", "2.2", "2.3"]))


def any_vtu(rng, **options):
    form = str(rng.choice(["ascii", "binary", "raw", "base64"]))
    compressor = "" if form == "ascii" else str(rng.choice(["", "ZLib", "LZMA", "LZ4"]))
    big, wide = rng.random(2) < 0.5
    return vtu(rng, form, compressor, versions(rng), big, wide, rng.choice(["f4", "f8"]), **options)


# Name: (ending, content, what a refusal must say or None).
KINDS = {
    "gmsh 2.2": (".msh", lambda rng: gmsh(rng, "2.2", False), None),
    "gmsh 2.2 binary": (".msh", lambda rng: gmsh(rng, "2.2", True), None),
    "gmsh 4.1": (".msh", lambda rng: gmsh(rng, "4.1", False), None),
    "gmsh 4.1 binary": (".msh", lambda rng: gmsh(rng, "4.1", True), None),
    "gmsh of second order": (".msh", lambda rng: gmsh(rng, "2.2", False, 17), "hexahedron of 20"),
    "gmsh partitioned": (".msh", lambda rng: gmsh(rng, "4.1", False, 5, True), "save it whole"),
    "vtu": (".vtu", any_vtu, None),
    "vtu of voxels": (".vtu", lambda rng: any_vtu(rng, cell=11), None),
    "vtu of second order": (".vtu", lambda rng: any_vtu(rng, cell=25), "quadratic hexahedron"),
    "inp flat": (".inp", lambda rng: inp(rng, False), None),
    "inp parts": (".inp", lambda rng: inp(rng, True), None),
    "inp same name": (".inp", lambda rng: inp(rng, True, True), None),
}


def read(path):
    """(exit code, message, (points, cells, sets, element_sets) or None)."""
    output, said = path.with_name("read.h5"), io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(io.StringIO()):
        code = convert.main(["mesh", str(path), str(output)])
    if code:
        return code, said.getvalue(), None
    with h5py.File(output) as file:
        groups = [
            {name: some[...] for name, some in file.get("mesh/" + key, {}).items()}
            for key in ("sets", "element_sets")
        ]
        return code, "", (file["mesh/points"][...], file["mesh/cells"][...], *groups)


def difference(found, name):
    """What differs from the body, or ""."""
    points, cells, sets, element_sets = found
    if points.shape != BODY.points.shape or cells.shape != BODY.cells.shape:
        return f"{points.shape} points, {cells.shape} cells"
    gaps = np.linalg.norm(points[:, None] - BODY.points, axis=2)
    node = gaps.argmin(axis=1)
    if gaps.min(axis=1).max() > 1e-7 or len(set(node)) < len(node):
        return f"nodes differ by {gaps.min(axis=1).max()}"
    wanted = {tuple(sorted(cell)): e for e, cell in enumerate(BODY.cells.tolist())}
    element = [wanted.get(tuple(sorted(cell)), -1) for cell in node[cells].tolist()]
    if sorted(element) != list(range(len(cells))):
        return "elements differ"
    own = {k: sorted(node[v].tolist()) for k, v in sets.items()}
    elements = {k: sorted(np.array(element)[v].tolist()) for k, v in element_sets.items()}
    nodes = {k: v.tolist() for k, v in BODY.sets.items()}
    if "inp" in name:
        nodes["ends"] = sorted({*nodes["foot"], *nodes["head"]})
        everything = list(range(len(points)))
        if name == "inp same name":
            nodes["Assembly.foot"], nodes["Body-1.foot"] = nodes.pop("foot"), everything
        elif "parts" in name:
            nodes["Set-1"] = everything
    if "vtu" not in name:
        nodes |= {k: np.unique(BODY.cells[v]).tolist() for k, v in BODY.element_sets.items()}
    if own != nodes:
        return f"sets {own} instead of {nodes}"
    if elements != {k: v.tolist() for k, v in BODY.element_sets.items()}:
        return f"element sets {elements}"
    return ""


def image_difference(found, wanted):
    """What differs from the voxels of an image, or ""."""
    points, cells, _, element_sets = found
    middles = points[cells].mean(axis=1)
    gaps = np.linalg.norm(middles[:, None] - wanted["middles"], axis=2)
    voxel, size = gaps.argmin(axis=1), wanted["volume"] ** (1 / 3)
    if sorted(voxel) != list(range(len(wanted["middles"]))) or gaps.min(axis=1).max() > 1e-5 * size:
        return "voxels differ"
    edges = points[cells[:, [1, 3, 4]]] - points[cells[:, [0]]]
    if not np.allclose(np.linalg.det(edges), wanted["volume"], rtol=1e-5):
        return "volumes differ"
    for label in (1, 7):
        own = sorted(voxel[element_sets.get(f"label-{label}", np.empty(0, int))])
        if own != np.flatnonzero(wanted["values"] == label).tolist():
            return f"label {label} differs"
    return ""


def check(folder, seed, name):
    """Writes a file of a kind, reads it; "" or what is wrong."""
    rng = np.random.default_rng(seed)
    if name == "nifti":
        path = folder / "image.nii"
        wanted = nifti(rng, path)
        code, said, found = read(path)
        return said if code else image_difference(found, wanted)
    ending, content, told = KINDS[name]
    path = folder / ("body" + ending)
    path.write_bytes(content(rng))
    code, said, found = read(path)
    if told:
        fine = code == 2 and told in said and str(path) in said
        return "" if fine else f"code {code}: {said!r}; expected {told}"
    return difference(found, name) if code == 0 else f"code {code}: {said}"


def mutilated(rng, data):
    """Data with bytes changed, left out or doubled, cut off, or with lines that change places."""
    data = bytearray(data)
    at, to = sorted(rng.integers(0, len(data), 2).tolist())
    way = rng.integers(5)
    if way == 0:
        return bytes(data[:at])
    if way == 1:
        for i in rng.integers(0, len(data), rng.integers(1, 5)):
            data[i] = rng.integers(0, 256)
    elif way == 2:
        del data[at : at + int(rng.integers(1, 40))]
    elif way == 3:
        data[at:at] = data[to : to + int(rng.integers(1, 40))]
    else:
        lines = bytes(data).split(b"\n")
        i, j = rng.integers(0, len(lines), 2)
        lines[i], lines[j] = lines[j], lines[i]
        return b"\n".join(lines)
    return bytes(data)


def mutilate(folder, count, seed):
    """Reads mutilated files; Counter of exit codes, of exceptions and of what is too slow."""
    rng, found = np.random.default_rng(seed), Counter()
    names = [*KINDS, "nifti"]
    for i in range(count):
        name = names[i % len(names)]
        if name == "nifti":
            nifti(rng, folder / "whole.nii")
            ending, data = ".nii", (folder / "whole.nii").read_bytes()
        else:
            ending, data = KINDS[name][0], KINDS[name][1](rng)
        path = folder / ("damaged" + ending)
        path.write_bytes(mutilated(rng, data))
        before = os.times().user
        try:
            code, said, _ = read(path)
            wrong = code not in (0, 2) or (code and not (said.strip() and path.name in said))
            result = f"WRONG {code} {name}: {said}" if wrong else code
        except BaseException as error:  # of any kind: it is what the test looks for
            result = f"WRONG {name}: {type(error).__name__}: {error}"
        if os.times().user - before > 5:
            result = f"WRONG {name}: slow"
        if isinstance(result, str):
            (folder / f"wrong-{i}{ending}").write_bytes(path.read_bytes())
        found[result] += 1
    return found


def main():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=0)
    parser.add_argument("--mutilate", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder for the files")
    options = parser.parse_args()
    names, wrong = [*KINDS, "nifti"], 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        for i in range(options.count):
            name = names[i % len(names)]
            if told := check(folder, options.seed * 10**6 + i, name):
                wrong += 1
                print(f"{name} {i}: {told}")
        if options.count:
            print(f"{options.count} files, {wrong} misread or refused without need")
        if options.mutilate:
            found = mutilate(folder, options.mutilate, options.seed)
            print(dict(found))
            wrong += sum(n for result, n in found.items() if isinstance(result, str))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
