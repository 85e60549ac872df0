"""Writers of the files of other programs, all of one body. Numbering, order, line ends, spelling
and encoding are drawn by chance.
"""

import gzip
import io
import struct
import tempfile
from pathlib import Path

import meshio
import numpy as np
from bodies import BODY, GROUPS, Body, lattice, with_nodes_of_elements
from vtk_writers import vtk, vtu

END = ("\n", "\r\n", "\r")  # of lines
UNITS = {"meter": 1.0, "micron": 1e-6, "mm": 1e-3, "unknown": 1e-3}  # of NIfTI, in m


def number(rng, count):
    """Numbers of nodes or elements, with gaps and in any order."""
    return rng.choice(np.arange(1, 5 * count), count, replace=False)


def gmsh(rng, version, binary=False, kind=5, partitioned=False):
    """A .msh file; kind is Gmsh's type of the volumes."""
    ids, order = number(rng, len(BODY.points)), rng.permutation(len(BODY.points))
    blocks = []
    for d, tag, name in GROUPS:
        nodes = ids[BODY.quads(name) if d == 2 else BODY.cells[BODY.element_sets[name]]]
        if d == 3 and kind != 5:  # of second order
            nodes = np.tile(nodes, 4)[:, : {17: 20, 12: 27}[kind]]
        blocks.append((d, tag, 3 if d == 2 else kind, nodes))
    blocks = [blocks[i] for i in rng.permutation(len(blocks))]
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
    text(f"$EndMeshFormat\n$PhysicalNames\n{len(GROUPS)}")
    for d, tag, name in GROUPS:
        text(f'{d} {tag} "{name}"')
    text("$EndPhysicalNames")
    n_elements = sum(len(block[3]) for block in blocks)
    first = 1
    if version == "2.2":
        text(f"$Nodes\n{len(ids)}")
        for n in order:
            put("i3d", ids[n], *BODY.points[n])
        text(f"$EndNodes\n$Elements\n{n_elements}")
        for _, tag, form, nodes in blocks:
            tags = (tag, tag, 2, 1, -3) if partitioned else (tag, tag)
            if binary:
                put("3i", form, len(nodes), len(tags))
            for row in nodes:
                head = (first, *tags) if binary else (first, form, len(tags), *tags)
                put(f"{len(head) + len(row)}i", *head, *row)
                first += 1
        text("$EndElements")
        return out.getvalue()
    if partitioned:
        text("$PartitionedEntities\n0\n$EndPartitionedEntities")
    text("$Entities")
    put("4Q", 0, 0, 3, 2)
    for d, tag, _ in GROUPS:
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


def by_meshio(ending, **options):
    """A file that meshio writes."""
    points, cells = BODY.marks("i4")
    if ending == "gmsh":
        blocks = [("quad", BODY.quads(name)) for name in BODY.sets]
        blocks += [("hexahedron", BODY.cells[some]) for some in BODY.element_sets.values()]
        tags = [np.full(len(nodes), tag) for (_, nodes), (_, tag, _) in zip(blocks, GROUPS)]
        cells = {"gmsh:physical": tags, "gmsh:geometrical": tags}
        names = {name: np.array([tag, d]) for d, tag, name in GROUPS}
        mesh = meshio.Mesh(BODY.points, blocks, {}, cells, names)
    else:
        cells = {name: [marks] for name, marks in cells.items()}
        mesh = meshio.Mesh(BODY.points, [("hexahedron", BODY.cells)], points, cells)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "body"
        getattr(meshio, ending).write(path, mesh, **options)
        return path.read_bytes()


def inp(rng, program, clash=False):
    """An .inp file: flat, of CalculiX's programs, or of parts as Abaqus/CAE writes them; with the
    same name in part and assembly if clash."""
    parts, calculix = program == "parts", program == "calculix"
    ids, numbers = number(rng, len(BODY.points)), number(rng, len(BODY.cells))
    comma = "," if calculix or rng.random() < 0.5 else ""
    move, axis, angle = rng.normal(size=3), rng.normal(size=3), rng.uniform(-180, 180)
    points = BODY.points
    if parts:  # where the instance's motion brings the body back to its place
        a, t = axis / np.linalg.norm(axis), -np.radians(angle)
        across = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
        turn = np.eye(3) + np.sin(t) * across + (1 - np.cos(t)) * across @ across
        points = points @ turn.T - move
    word = (str.upper, str.lower, str.title)[rng.integers(3)]
    body = [word("*node") + (", NSET=Nall" if calculix else "")]
    rows = rng.permutation(len(ids))
    body += [f"{ids[n]}, " + ", ".join(map(repr, points[n].tolist())) + comma for n in rows]
    body.append(word("*element") + ", type=C3D8" + ("" if calculix else "R"))
    for e in rng.permutation(len(numbers)):
        row = [numbers[e], *ids[BODY.cells[e]]]
        cut = int(rng.integers(4, 9))
        lines = [row] if rng.random() < 0.7 else [row[:cut], row[cut:]]
        body += [
            ", ".join(map(str, line)) + ("," if line is not lines[-1] else comma) for line in lines
        ]
    instance = ", instance=Body-1" if parts else ""
    nodes, elements, some = {}, {}, []  # what the file holds besides the body's sets

    def put(kind, name, members, of):
        some.append(f"{word('*' + kind)}, {kind}={name}{instance}")
        wide = 1 if calculix else 16
        for i in range(0, len(members), wide):
            some.append(", ".join(map(str, of[members[i : i + wide]])) + comma)

    ways = [0, 0, 0] if clash else rng.integers(0, 3, 3).tolist()
    for way, (name, members) in zip(ways, BODY.sets.items()):
        surface = f"{word('*surface')}, name={name}, type="
        if way == 0:
            put("nset", name, members, ids)
        elif way == 1:
            nodes[f"_{name}_CNS_"] = members
            put("nset", f"_{name}_CNS_", members, ids)
            some += [surface + "NODE", f"_{name}_CNS_, 1."]
        else:
            lines, faces = [surface + "ELEMENT"], BODY.faces(name)
            for side in np.unique(faces[:, 1]) if parts else ():
                own = f"_{name}_S{side + 1}"
                elements[own] = faces[faces[:, 1] == side, 0]
                put("elset", own, elements[own], numbers)
                lines.append(f"{own}, S{side + 1}")
            if not parts:
                lines += [f"{numbers[e]}, S{side + 1}" + comma for e, side in faces]
            some += lines
    for name, members in BODY.element_sets.items():
        put("elset", name, members, numbers)
    if ways[:2] == [0, 0]:
        nodes["ends"] = np.union1d(BODY.sets["foot"], BODY.sets["head"])
        late = [f"{word('*nset')}, nset=ends", "foot, head"]
        some = late + some if rng.random() < 0.5 else some + late
    every = np.arange(len(ids))
    if parts:
        nodes["Body-1.foot" if clash else "Set-1"] = every
        whole = [
            "*Nset, nset=" + ("foot" if clash else "Set-1") + ", generate",
            f" 1, {max(ids)}, 1",
        ]
        other = ["*Part, name=Unused", "*Node", "1, 0., 0., 0.", "*End Part"]
        place = ", ".join(map(repr, move.tolist()))
        turn = ", ".join(map(repr, [0.0, 0.0, 0.0, *axis.tolist(), float(angle)]))
        body = ["*Heading", "*Part, name=Body", *body, *whole, "*End Part", *other]
        body += ["*Assembly, name=Assembly", "*Instance, name=Body-1, part=Body", place, turn]
        body += ["*End Instance", *some, "*End Assembly", "*Step", "*Static", "1., 1.", "*End Step"]
    else:
        body += some
        nodes |= {"Nall": every} if calculix else {}
    for _ in range(3):
        body.insert(int(rng.integers(1, len(body))), "** a comment, 1, 2")
    end = str(rng.choice(END))
    mark = b"\xef\xbb\xbf" if rng.random() < 0.3 else b""
    return mark + (end.join(body) + end).encode(), with_nodes_of_elements(nodes, elements)


def nifti(rng):
    """A labelled image in any orientation, unit, type and scale, and its Body of voxels."""
    import nibabel

    labels = np.zeros((3, 4, 5), dtype=np.int16)
    labels[1:, :3, :4] = 1
    labels[2, 1, 1:3] = 7
    unit = str(rng.choice(list(UNITS)))
    turn = np.eye(3)[rng.permutation(3)] * rng.choice([-1, 1], 3)
    oblique = np.linalg.qr(rng.normal(size=(3, 3)))[0] if rng.random() < 0.5 else np.eye(3)
    affine = np.eye(4)
    affine[:3, :3] = oblique @ turn * rng.uniform(0.5, 3, 3)
    affine[:3, 3] = rng.normal(size=3)
    kind, slope = rng.choice(["i2", "u1", "f4", "f8"]), rng.choice([1.0, 0.1, 0.3, 2.0])
    scaled = slope != 1 and kind[0] == "f"
    version = nibabel.Nifti2Image if rng.random() < 0.3 else nibabel.Nifti1Image
    image = version((labels / slope if scaled else labels).astype(kind), affine)
    image.header.set_xyzt_units(unit)
    code = int(rng.choice([1, 2]))
    image.set_qform(affine, code)
    # The quaternion of a qform is rounded, and near half a turn its first part is then lost.
    rotation = affine[:3, :3] / np.linalg.norm(affine[:3, :3], axis=0)
    rotation[:, 2] *= np.linalg.det(rotation)
    image.set_sform(affine, 0 if np.trace(rotation) > -0.5 and rng.random() < 0.5 else code)
    data = bytearray(image.to_bytes())
    if scaled:  # nibabel scales by itself: set what the header says of raw numbers
        at, form = (112, "<2f") if version is nibabel.Nifti1Image else (176, "<2d")
        data[at : at + struct.calcsize(form)] = struct.pack(form, slope, 0)
    at, cells = lattice(np.argwhere(labels))
    points = ((at - 0.5) @ affine[:3, :3].T + affine[:3, 3]) * UNITS[unit]
    values = labels[labels > 0]
    marked = {f"label-{value}": np.flatnonzero(values == value) for value in (1, 7)}
    return bytes(data), Body(points, cells, {}, marked)


def packed(rng):
    """The same, compressed."""
    data, body = nifti(rng)
    return gzip.compress(data), body


def npy(rng):
    """A labelled array; the size of its voxels is not in the file."""
    out = io.BytesIO()
    np.save(out, np.ones((2, 2, 2), "i2"))
    return out.getvalue()


def of_gmsh(*options):
    """The writer of a .msh file, and the body that it holds."""
    return lambda rng: (gmsh(rng, *options), with_nodes_of_elements())


def of_meshio(ending, **options):
    """The writer of a file of meshio, and the body that it holds."""
    body = with_nodes_of_elements() if ending == "gmsh" else BODY
    return lambda rng: (by_meshio(ending, **options), body)


def of_inp(*options):
    return lambda rng: inp(rng, *options)


# Name: (ending, function of a random generator that returns the file and its body, what a refusal
# must say or None).
KINDS = {
    "gmsh 2.2": (".msh", of_gmsh("2.2"), None),
    "gmsh 2.2 binary": (".msh", of_gmsh("2.2", True), None),
    "gmsh 2.2 partitioned": (".msh", of_gmsh("2.2", False, 5, True), None),
    "gmsh 4.1": (".msh", of_gmsh("4.1"), None),
    "gmsh 4.1 binary": (".msh", of_gmsh("4.1", True), None),
    "gmsh of 20 nodes": (".msh", of_gmsh("2.2", False, 17), "hexahedron of 20"),
    "gmsh of 27 nodes": (".msh", of_gmsh("4.1", True, 12), "hexahedron of 27"),
    "gmsh partitioned": (".msh", of_gmsh("4.1", False, 5, True), "save it whole"),
    "meshio 2.2": (".msh", of_meshio("gmsh", fmt_version="2.2", binary=False), None),
    "meshio 2.2 binary": (".msh", of_meshio("gmsh", fmt_version="2.2", binary=True), None),
    "meshio vtu": (".vtu", of_meshio("vtu"), None),
    "meshio vtu text": (".vtu", of_meshio("vtu", binary=False), None),
    "meshio vtk": (".vtk", of_meshio("vtk"), None),
    "meshio vtk 4.2": (".vtk", of_meshio("vtk", fmt_version="4.2", binary=False), None),
    "vtu": (".vtu", lambda rng: (vtu(rng), BODY), None),
    "vtu of voxels": (".vtu", lambda rng: (vtu(rng, 11), BODY), None),
    "vtu of second order": (".vtu", lambda rng: (vtu(rng, 25), BODY), "quadratic hexahedron"),
    "vtk": (".vtk", lambda rng: (vtk(rng, False), BODY), None),
    "vtk binary": (".vtk", lambda rng: (vtk(rng, True), BODY), None),
    "vtk of voxels": (".vtk", lambda rng: (vtk(rng, True, 11), BODY), None),
    "vtk of wedges": (".vtk", lambda rng: (vtk(rng, False, 13), BODY), "type 'wedge'"),
    "vtk image": (
        ".vtk",
        lambda rng: (vtk(rng, True, 12, "STRUCTURED_POINTS"), BODY),
        "type STRUCT",
    ),
    "inp flat": (".inp", of_inp("flat"), None),
    "inp of CalculiX": (".inp", of_inp("calculix"), None),
    "inp parts": (".inp", of_inp("parts"), None),
    "inp same name": (".inp", of_inp("parts", True), None),
    "nifti": (".nii", nifti, None),
    "nifti packed": (".nii.gz", packed, None),
    "array": (".npy", lambda rng: (npy(rng), None), "mesh.spacing = [x, y, z]"),
}
