"""Gmsh's meshes: every version and encoding gives the same mesh and all of its groups."""

import numpy as np
import pytest
from meshes import DATA, Refused, read

FORMS = ("2.2", "2.2-binary", "4.1", "4.1-binary", "4.1-parametric")
SIDES = np.array([0.1, 0.1, 0.2])

# Which nodes of block.geo a group has, by their places; "head plate" is named with a minus sign,
# "all" is a second group of the same volume, and surface 77 has no name.
GROUPS = {
    "foot": lambda x: x[:, 2] == 0,
    "head plate": lambda x: x[:, 2] == 0.2,
    "edge": lambda x: (x[:, 1] == 0) & (x[:, 2] == 0),
    "corner": lambda x: (x == [0.1, 0.1, 0]).all(axis=1),
    "tissue": lambda x: x[:, 0] >= 0,
    "all": lambda x: x[:, 0] >= 0,
    "surface-77": lambda x: x[:, 1] == 0,
}


def expected_sets(points):
    """The groups of block.geo, by the places of its nodes."""
    rounded = points.round(12)
    return {name: np.flatnonzero(rule(rounded)).tolist() for name, rule in GROUPS.items()}


@pytest.mark.parametrize("form", FORMS)
def test_mesh_and_groups(tmp_path, capsys, form):
    path = tmp_path / "block.msh"
    path.write_bytes((DATA / f"block-{form}.msh").read_bytes())
    points, cells, sets, warnings = read(capsys, path)
    assert not warnings
    assert cells.shape == (12, 8) and len(np.unique(cells)) == len(points) == 36
    # 2 x 2 x 3 boxes: edges along the axes, and vertex 6 opposite to vertex 0; of 16 digits.
    edges = points[cells[:, [1, 3, 4]]] - points[cells[:, [0]]]
    assert np.allclose(np.linalg.det(edges), SIDES.prod() / 12, rtol=1e-12)
    assert np.allclose(points[cells[:, 6]] - points[cells[:, 0]], edges.sum(axis=1), atol=1e-15)
    assert sets == expected_sets(points)
    assert [len(sets[name]) for name in GROUPS] == [9, 9, 3, 1, 36, 36, 12]


def edited(tmp_path, form, *changes):
    """A fixture with texts replaced."""
    data = (DATA / f"block-{form}.msh").read_bytes()
    for old, new in changes:
        assert old in data, old
        data = data.replace(old, new)
    (tmp_path / "block.msh").write_bytes(data)
    return tmp_path / "block.msh"


@pytest.mark.parametrize(
    "form, old, new, message",
    [
        ("4.1", b"4.1 0 8", b"4.0 0 8", "version 4.0 of .msh; allowed are 2.2 and 4.1"),
        ("4.1", b"4.1 0 8", b"4.1 7 8", r"\$MeshFormat must be"),
        ("4.1-binary", b"4.1 1 8\n\1", b"4.1 1 8\n\2", r"\$MeshFormat is damaged"),
        ("2.2", b"$EndNodes", b"$Ennodes", r"\$Nodes has no \$EndNodes: the file is cut off"),
        ("2.2", b"$MeshFormat\n", b"", r":2: \$EndMeshFormat ends no section: the file is dam"),
        ("2.2", b"Nodes", b"Nodos", r"section \$Nodes is missing"),
        ("2.2", b"\n2 0.1 0 0\n", b"\n2 nan 0 0\n", "finite; those of node 2 are not"),
        ("2.2", b"\n2 0.1 0 0\n", b"\n2 0.1 x 0\n", r":16: \$Nodes is damaged: 'x' is not a n"),
        ("2.2", b"\n2 0.1 0 0\n", b"\n1 0.1 0 0\n", "node 1 given twice"),
        ("2.2", b"\n2 0.1 0 0\n", b"\n-2 0.1 0 0\n", "node -2: ids of nodes must not be negative"),
        ("2.2", b"\n2 0.1 0 0\n", b"\n2.5 0.1 0 0\n", "not a whole number"),
        ("2.2", b" 9 2 10 25 ", b" 9 99 10 25 ", "element .* names node 99, which does not exist"),
        ("2.2", b" 9 2 10 25 ", b" 9 9 10 25 ", "1 of 12 elements name a node twice"),
        ("2.2", b"\n36\n", b"\n37\n", "Nodes"),
        ("2.2", b"\n36\n", b"\n-36\n", "Nodes"),
        ("4.1", b'2 1 "foot"', b"2 1", r":8: \$PhysicalNames: '2 1': dimension, tag and"),
        ("4.1", b'2 1 "foot"\n', b"", r":5: \$PhysicalNames: '6' names are announced, but 5"),
        ("4.1", b"\n27 36 1 36\n", b"\n28 36 1 36\n", r"\$Nodes"),
        ("4.1", b"\n27 36 1 36\n", b"\n99999999999999999999 36 1 36\n", r"\$Nodes"),
        ("4.1", b"3 1 5 12", b"3 1 4 12", r"\$Elements|tetrahedron"),
        ("4.1", b"3 1 5 12", b"3 1 99 12", "Gmsh's type 99"),
        ("4.1", b"3 1 5 12", b"3 1 5.5 12", r"\$Elements is damaged: '5.5' is not a whole number"),
        ("4.1", b"\n27 36 1 36\n", b"\n27 36 1.5 36\n", r":\d+: \$Nodes is damaged: '1.5' is not"),
        ("2.2", b"\n2 0.1 0 0\n", b"\n2 1_0 0 0\n", r":16: \$Nodes is damaged: '1_0' is not a n"),
        ("2.2", b"$PhysicalN", b"$Nodes\n0\n$EndNodes\n$PhysicalN", r"\$Nodes is given twice"),
    ],
)
def test_damage_is_named(tmp_path, capsys, form, old, new, message):
    with pytest.raises(Refused, match=message):
        read(capsys, edited(tmp_path, form, (old, new)))


def test_a_hexahedron_of_several_groups_is_one(tmp_path, capsys):
    """Version 2.2 lists it again, with another id; in blocks of any length between other kinds."""
    path = edited(tmp_path, "2.2")
    head, tail = path.read_text().split("$Elements\n")
    count, *lines = tail.split("$EndElements")[0].splitlines()
    mixed = [line for pair in zip(lines[:30], reversed(lines[30:])) for line in pair]
    mixed += lines[len(mixed) // 2 : len(lines) - len(mixed) // 2]
    assert sorted(mixed) == sorted(lines) and int(count) == len(lines)
    path.write_text(head + "\n".join(["$Elements", count, *mixed, "$EndElements", ""]))
    points, cells, sets, _ = read(capsys, path)
    assert len(cells) == 12 and sets == expected_sets(points)


def test_names_in_the_encoding_of_windows(tmp_path, capsys):
    path = edited(tmp_path, "4.1", (b'"foot"', '"Fuß"'.encode("cp1252")))
    assert len(read(capsys, path)[2]["Fuß"]) == 9


def test_groups_of_one_name_are_kept_apart(tmp_path, capsys):
    """A curve and a surface: neither has the name alone."""
    path = edited(tmp_path, "2.2", (b'2 1 "foot"', b'2 1 "edge"'))
    points, _, sets, _ = read(capsys, path)
    expected = expected_sets(points)
    expected["surface-1.edge"], expected["curve-3.edge"] = expected.pop("foot"), expected.pop(
        "edge"
    )
    assert sets == expected


def test_node_without_element_is_left_out(tmp_path, capsys):
    path = edited(tmp_path, "2.2", (b"$Nodes\n36\n", b"$Nodes\n37\n4000000000 7 7 7\n"))
    points, _, sets, warnings = read(capsys, path)
    assert len(points) == 36 and sets == expected_sets(points)
    assert "dropped 1 node of no hexahedron, hence without mass: 4000000000" in warnings


def test_group_without_nodes_of_hexahedra_is_left_out(tmp_path, capsys):
    old, new = b'\n2 1 "foot"', b'\n2 9 "nothing"\n2 1 "foot"'
    path = edited(tmp_path, "4.1", (b"$PhysicalNames\n6", b"$PhysicalNames\n7"), (old, new))
    _, _, sets, warnings = read(capsys, path)
    assert set(sets) == set(GROUPS)
    assert "dropped set 'nothing': it has no node of a hexahedron" in warnings


def test_an_entity_may_have_no_nodes(tmp_path, capsys):
    """Gmsh writes such blocks, of one- and two-dimensional meshes at least."""
    old, new = b"$Nodes\n27 36 ", b"$Nodes\n28 36 "
    path = edited(tmp_path, "4.1", (old, new), (b"$EndNodes", b"3 9 0 0\n$EndNodes"))
    points, _, sets, _ = read(capsys, path)
    assert len(points) == 36 and sets == expected_sets(points)


@pytest.mark.parametrize(
    "other, message", [(True, "type 'hexahedron of 20"), (False, "has only line")]
)
def test_how_gmsh_makes_hexahedra_is_explained(tmp_path, capsys, other, message):
    """Files without hexahedra: with other volume elements, or none as no group saves them."""
    text = (DATA / "block-2.2.msh").read_bytes().decode()
    begin, end = text.index("$Elements"), text.index("$EndElements")
    lines = text[begin:end].splitlines()[2:]
    kept = [line for line in lines if line.split()[1] != "5"]
    if other:
        kept.append("9 17 2 10 25 " + " ".join(map(str, range(1, 21))))
    elements = "\n".join(["$Elements", str(len(kept)), *kept, ""])
    (tmp_path / "a.msh").write_text(text[:begin] + elements + text[end:])
    with pytest.raises(Refused, match=message + ".*Transfinite Volume.*`gmsh -3`.*Physical Volume"):
        read(capsys, tmp_path / "a.msh")


def test_names_keep_spaces_and_letters_but_no_slashes(tmp_path, capsys):
    path = edited(tmp_path, "4.1", (b'"foot"', "\"Fuß/left 'a'\"".encode()))
    _, _, sets, warnings = read(capsys, path)
    assert len(sets["Fuß_left 'a'"]) == 9
    assert "is renamed 'Fuß_left 'a''" in warnings
