"""Abaqus and CalculiX input files: nodes, bricks and sets in every supported notation."""

import numpy as np
import pytest
from meshes import CELLS, CUBES, DATA, ELEMENTS, NODES, POINTS, Refused, read

from exchange import abaqus_writer
from common.errors import InputError
from exchange.foreign_mesh import HexMesh

FIRST, SECOND, TOP = list(range(8)), list(range(4, 12)), list(range(8, 12))
SKIN = {"a": [0, 1, 2, 3], "s": [0, 1, 2, 3]}
# The nodes of the first cube on each of its sides, as in Abaqus's manual.
SIDES = [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 4, 5], [1, 2, 5, 6], [2, 3, 6, 7], [0, 3, 4, 7]]


def read_text(tmp_path, capsys, text):
    (tmp_path / "cubes.inp").write_text(text, encoding="utf-8")
    return read(capsys, tmp_path / "cubes.inp")


@pytest.mark.parametrize(
    "text",
    [
        CUBES,
        CUBES.lower(),
        CUBES.replace("\n", "\r\n"),
        "\ufeff" + CUBES.replace("\n", "\r"),
        CUBES.replace("\n", ",\n").replace("*NODE,", "*NODE").replace("tissue,", "tissue"),
        CUBES.replace("\n3, ", "\n** a comment\n\n3, "),
        CUBES.replace("\n7, 1.", "\n*NODE, NSET=upper\n7, 1."),
        CUBES.replace("1., ", "1.0D+00, "),
        CUBES.replace("TYPE=C3D8R, ELSET=tissue", "TYPE=C3D8R,\n ELSET=tissue"),
        CUBES.replace(" 5, 6, 7, 8\n", " 5,\n 6, 7, 8\n"),
        CUBES.replace("\n2, 5, 6", "\n*ELEMENT, ELSET=tissue, TYPE=C3D8I\n2, 5, 6"),
        "*HEADING\nany, words\n*PART, NAME=p\n" + CUBES + "*END PART\n*INSTANCE, NAME=a, PART=p\n",
        CUBES + "*ELEMENT, TYPE=SFM3D4\n7, 1, 2, 3, 4\n",
    ],
)
def test_the_same_mesh_however_written(tmp_path, capsys, text):
    points, cells, sets, warnings = read_text(tmp_path, capsys, text)
    assert (points == POINTS).all() and (cells == CELLS).all() and not warnings
    assert sets["tissue"] == list(range(12))


@pytest.mark.parametrize(
    "text, expected",
    [
        ("*NSET, NSET=Foot\n1, 2, 3,\n4\n", {"Foot": [0, 1, 2, 3]}),
        ("*Nset, nset=Foot, Generate\n1, 4\n", {"Foot": [0, 1, 2, 3]}),
        ("*NSET, GENERATE, NSET=Foot\n1, 3, 2\n9, 12, 3\n", {"Foot": [0, 2, 8, 11]}),
        ("*NSET, NSET=Foot\n1\n*NSET, NSET=FOOT\n2\n", {"Foot": [0, 1]}),
        ("*NSET, NSET=a\n1\n*NSET, NSET=Foot\nA, 2\n", {"a": [0], "Foot": [0, 1]}),
        ('*NSET, NSET="left, Fuß"\n3\n', {"left, Fuß": [2]}),
        ("*ELSET, ELSET=upper\n2\n", {"upper": SECOND}),
        (
            "*ELSET, ELSET=up, GENERATE\n2, 2\n*ELSET, ELSET=same\nup\n",
            {"up": SECOND, "same": SECOND},
        ),
        ("*ELSET, ELSET=low\n1\n*NSET, NSET=Foot, ELSET=low\n", {"low": FIRST, "Foot": FIRST}),
        ("*ELSET, ELSET=both\n1\n*NSET, NSET=both\n12\n", {"both": [11]}),
        ("*ELSET, ELSET=BOTH\n1\n*NSET, NSET=both\n12\n", {"both": [11]}),
        ("*ELEMENT, TYPE=S4, ELSET=skin\n9, 1, 2, 3, 4\n", {"skin": [0, 1, 2, 3]}),
        ("*ELEMENT, TYPE=B31, ELSET=rod\n9, 1, 2,\n10, 2, 3,\n", {"rod": [0, 1, 2]}),
        (
            "*ELEMENT, TYPE=M3D4, ELSET=skin\n9, 1, 2, 3, 4,\n10, 2, 3, 7, 6,\n",
            {"skin": [0, 1, 2, 3, 5, 6]},  # neither node 10 nor any other of no face
        ),
        ("*NSET, NSET=Foot, GENERATE\n7, 900, 2\n", {"Foot": [6, 8, 10]}),
        ("*NSET, NSET=a\nFoot, 3\n*NSET, NSET=foot\n1\n", {"a": [0, 2], "foot": [0]}),
        ("*ELEMENT, TYPE=S8R, ELSET=skin\n9, 1, 2, 3, 4,\n5, 6, 7, 8\n", {"skin": FIRST}),
        ("*SURFACE, NAME=s, TYPE=NODE\n3, 0.5\n12,\n", {"s": [2, 11]}),
        ("*NSET, NSET=a\n1, 2\n*SURFACE, TYPE=NODE, NAME=s\nA\n", {"a": [0, 1], "s": [0, 1]}),
        ("*SURFACE, NAME=s\ntissue, S1\n", {"s": [0, 1, 2, 3, 4, 5, 6, 7]}),
        *((f"*SURFACE, NAME=s\n1, s{i}\n", {"s": s}) for i, s in enumerate(SIDES, 1)),
        ("*SURFACE, NAME=s\n2,\n", {"s": list(range(4, 12))}),
        ("*ELEMENT, TYPE=S4, ELSET=a\n9, 1, 2, 3, 4\n*SURFACE, NAME=s\na, SPOS\n", SKIN),
        # The set of all nodes of an element differs from its face of the same name.
        ("*ELSET, ELSET=s\n2\n*SURFACE, NAME=s\ns, S2\n", {"Set.s": SECOND, "Surface.s": TOP}),
    ],
)
def test_sets(tmp_path, capsys, text, expected):
    _, _, sets, warnings = read_text(tmp_path, capsys, CUBES + text)
    del sets["tissue"]
    assert sets == expected
    assert not warnings or "elements that are no hexahedra define sets, without" in warnings


def test_what_is_ignored_is_named(tmp_path, capsys):
    """Keywords by their first lines, misspelt ones with the right one; elements by their type."""
    text = CUBES + "*ELEMENT, TYPE=S4R\n7, 1, 2, 3, 4\n*ELEMENT, TYPE=MASS\n8, 1\n9, 2\n"
    text += "*N SET, NSET=a\n1\n*Tie, name=t\na, b\n*STEP\n*Static\n1., 1.\n*STEP\n*END STEP\n"
    *_, sets, warnings = read_text(tmp_path, capsys, text)
    assert set(sets) == {"tissue"} and warnings.count("warning") == 2
    assert (
        "not read: *N SET (cubes.inp:22, did you mean *NSET?), *TIE (cubes.inp:24), "
        "*STEP (cubes.inp:26), *STATIC (cubes.inp:27); materials, constraints, ties and loads"
    ) in warnings
    assert "define sets, without stiffness or mass: 1 of type S4R, 2 of type MASS" in warnings


def test_names_in_the_encoding_of_windows(tmp_path, capsys):
    (tmp_path / "cubes.inp").write_bytes((CUBES + "*NSET, NSET=Fuß\n1\n").encode("cp1252"))
    assert read(capsys, tmp_path / "cubes.inp")[2]["Fuß"] == [0]


@pytest.mark.parametrize(
    "text, message",
    [
        (
            "*SURFACE, NAME=s, TYPE=CUTTING SURFACE\n",
            ":17: surface 's': only TYPE=NODE and TYPE=EL",
        ),
        ("*SURFACE, NAME=s, COMBINE=UNION\na, b\n", ":17: surface 's': only TYPE=NODE and TYPE=EL"),
        ("*SURFACE, NAME=s\n1, SPOS\n", ":18: surface 's': face SPOS of such elements is not read"),
        (
            "*ELEMENT, TYPE=S4\n9, 1, 2, 3, 4\n*SURFACE, NAME=s\n9, E1\n",
            ":20: surface 's': face E1",
        ),
    ],
)
def test_a_surface_that_is_not_read_is_warned_of(tmp_path, capsys, text, message):
    _, _, sets, warnings = read_text(tmp_path, capsys, CUBES + text)
    assert "s" not in sets and message in warnings
    assert "; list its nodes as *NSET if the case needs them" in warnings


def test_nodes_with_two_coordinates_are_warned_of(tmp_path, capsys):
    text = CUBES.replace("1, 0., 0., 0.", "1, 0., 0.").replace("2, 1., 0., 0.", "2, 1., 0.,")
    points, *_, warnings = read_text(tmp_path, capsys, text)
    assert (points == POINTS).all()
    assert (
        "cubes.inp:2: 2 of 12 nodes have fewer than three coordinates, the first here" in warnings
    )


def test_what_gmsh_writes(tmp_path, capsys):
    (tmp_path / "block.inp").write_bytes((DATA / "block.inp").read_bytes())
    points, cells, sets, warnings = read(capsys, tmp_path / "block.inp")
    assert cells.shape == (12, 8) and warnings.count("warning") == 1 and "of type T3D2" in warnings
    assert sets["foot"] == np.flatnonzero(points[:, 2] == 0).tolist() and len(sets["edge"]) == 3


def test_included_files(tmp_path, capsys):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "nodes.inc").write_text(NODES)
    (tmp_path / "parts" / "some.inc").write_text("".join(NODES.splitlines(True)[:5]))
    (tmp_path / "parts" / "some.txt").write_text("".join(NODES.splitlines(True)[1:5]))
    (tmp_path / "parts" / "nodes.txt").write_text(NODES.removeprefix("*NODE\n"))
    for start in (
        "*INCLUDE, INPUT=parts/nodes.inc\n",
        "*NODE, INPUT=parts/nodes.txt\n",
        "*NODE\n*INCLUDE, INPUT=parts/nodes.txt\n",
        # Data lines that follow belong to the last keyword before them, wherever it is.
        "*NODE\n*INCLUDE, INPUT=parts/some.txt\n" + "".join(NODES.splitlines(True)[5:]),
        "*INCLUDE, INPUT=parts/some.inc\n" + "".join(NODES.splitlines(True)[5:]),
    ):
        points, cells, _, _ = read_text(tmp_path, capsys, start + ELEMENTS)
        assert (points == POINTS).all() and (cells == CELLS).all()


# As Abaqus/CAE writes it: one cube of CUBES twice, sets of the same name in part and assembly.
ASSEMBLY = (
    "*Part, name=Cube\n"
    + CUBES[: CUBES.index("\n2, 5, 6") + 1]
    + """*Nset, nset=Set-1, generate
 1, 8, 1
*Nset, nset=Top
 5, 6, 7, 8
*End Part
*Part, name=Unused
*Node
1, 7., 7., 7.
*End Part
*Assembly, name=Assembly
*Instance, name=Low, part=Cube
*End Instance
*Instance, name=High, part=Cube
0., 0., 3.
0., 0., 3., 0., 0., 4., 90.
*End Instance
*Nset, nset=Set-1, instance=Low, generate
1, 4
*Nset, nset=Both, instance=Low
Top
*Nset, nset=Both
High.Top, High.1
*End Assembly
"""
)


def test_instances_are_placed_and_keep_their_sets(tmp_path, capsys):
    """The second is moved by 3 in z, then turned by 90 degrees about that axis: x to y, y to -x."""
    points, cells, sets, warnings = read_text(tmp_path, capsys, ASSEMBLY)
    own = POINTS[:8]
    turned = np.column_stack([-own[:, 1], own[:, 0], own[:, 2] + 3])
    assert np.allclose(points, np.vstack([own, turned]), rtol=0, atol=1e-15)
    assert (cells == [range(8), range(8, 16)]).all()
    assert warnings.count("warning") == 1 and "dropped 8 nodes of no hexahedron" in warnings
    assert sets == {
        "Low.tissue": list(range(8)),
        "High.tissue": list(range(8, 16)),
        "Assembly.Set-1": [0, 1, 2, 3],
        "Low.Set-1": list(range(8)),
        "High.Set-1": list(range(8, 16)),
        "Low.Top": [4, 5, 6, 7],
        "High.Top": [12, 13, 14, 15],
        "Both": [4, 5, 6, 7, 8, 12, 13, 14, 15],
    }


def test_messages_name_the_instance(tmp_path, capsys):
    with pytest.raises(Refused, match=":38: set 'Both' names node 99 of 'High', which does not"):
        read_text(tmp_path, capsys, ASSEMBLY.replace("High.1\n", "High.99\n"))


@pytest.mark.parametrize(
    "text, message",
    [
        ("", "has no nodes"),
        ("1, 2\n", "cubes.inp:1: '1, 2' comes before the first"),
        (NODES, "has no elements; eight-node hexahedra are required"),
        (NODES + "*ELEMENT, TYPE=S4\n1, 1, 2, 3, 4\n", "has only S4; eight-node hexahedra"),
        (
            CUBES + "*ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 5\n8, 1, 2, 3, 6\n",
            "2 of type 'C3D4', besides 2 hex",
        ),
        (CUBES + "*ELEMENT, TYPE=C3D20R\n7, 1, 2, 3, 5\n", "1 of type 'C3D20R'"),
        (CUBES.replace("TYPE=C3D8R, ", ""), ":14: .ELEMENT needs TYPE="),
        (CUBES.replace("2, 5, 6, 7,", "2, 5, 6,"), ":16: C3D8R needs an id and eight nodes"),
        (CUBES.replace("2, 5, 6, 7,", "2, 5, 6, x,"), ":16: 'x' must be a whole number"),
        (CUBES.replace("12, 0., 1.", "12, 0., l."), ":13: 'l.' must be a number"),
        (
            CUBES.replace("12, 0., 1., 2.", "12"),
            ":13: '12': a node needs an id and three coordinates",
        ),
        (CUBES.replace("12, 0., 1., 2.", "12, 0., 1., 2., 3."), ":13: .*: a node needs an id"),
        # NumPy ends a text at such words, or takes them for numbers.
        (CUBES.replace("12, 0., 1., 2.", "12, 0., 1., 2.0-1"), ":13: '2.0-1' must be a number"),
        (CUBES.replace("12, 0., 1., 2.", "12, 0., 1., 1_0"), ":13: '1_0' must be a number"),
        (CUBES.replace("11, 12", "11, 12-3"), ":16: '12-3' must be a whole number"),
        (CUBES.replace("11, 12", "11, 12.5"), ":16: '12.5' must be a whole number"),
        (CUBES.replace("11, 12", "11, 1_2"), ":16: '1_2' must be a whole number"),
        ("*PART, NAME=p\n*END PART\n*PART, NAME=P\n", ":3: .PART: 'P' is given twice"),
        (
            "*PART, NAME=p\n*END PART\n*PART, NAME=q\n*INSTANCE, NAME=i, PART=p\n",
            ":4: .INSTANCE: parts hold no instances; close .PART before it",
        ),
        (NODES + "*ELEMENTS, TYPE=C3D8\n", "has no elements"),
        (CUBES.replace("12, 0., 1., 2.", "12, 0.,, 1., 2."), ":13: .*: a node needs an id and"),
        (CUBES + "*NSET, NSET=Foot\n1,, 2\n", ":18: .NSET: a member is missing between two"),
        (CUBES + "*SURFACE\n1, S1\n", ":17: .SURFACE needs a name: NAME="),
        (CUBES + "*SURFACE, NAME=s\nup, S1\n", ":18: set 'up' of elements is not defined"),
        (CUBES.replace("12, 0., 1.", "12, 0., inf"), "finite; those of node 12 are not"),
        (CUBES.replace("12, 0., 1.", "-12, 0., 1."), "node -12: ids of nodes must not be negative"),
        (CUBES.replace("12, 0., 1.", "9223372036854775808, 0., 1."), "must be a whole number"),
        (CUBES.replace("12, 0., 1.", "9223372036854775807, 0., 1."), "element 2 names node 12"),
        (
            CUBES.replace("\n2, 5, 6", "\n1, 5, 6"),
            "1 of 2 elements share an id with another; ids must be unique: 1",
        ),
        (CUBES + "*NSET, NSET=Foot\n1, -1\n", ":18: set 'Foot' names node -1, which does not"),
        (NODES + "*ELSET, ELSET=up\n1\n", ":15: set 'up' names element 1, which does not exist"),
        (CUBES + "*NSET, NSET=Foot\n1, 13\n", "set 'Foot' names node 13, which does not exist"),
        (
            CUBES + "*NSET, NSET=Foot\nToes\n",
            ":18: set 'Toes' of nodes is not defined in the file",
        ),
        (CUBES + "*NSET\n1\n", ":17: .NSET needs a name"),
        (CUBES.replace("7, 8\n2, 5", "7\n8, 2, 5"), ":16: C3D8R needs an id and eight nodes"),
        (CUBES + "*ELEMENT, TYPE=U1\n7, 1,\n8, 2,\n", ":18: ends with a comma; where its element"),
        (CUBES + "*PART, NAME=p\n*END PART\n*INSTANCE, NAME=i, PART=q\n", "PART=, of p"),
        ("*PART, NAME=p\n*END PART\n*PART, NAME=q\n*END PART\n", "parts p, q are not placed"),
        (
            "*PART, NAME=p\n*END PART\n*INSTANCE, NAME=i, PART=p\n1, 2\n",
            ":3: .INSTANCE: a line of three numbers .translation. and one of seven",
        ),
        ("*NODE, INPUT=none.txt\n", "none.txt: cannot be read: No such file"),
        ("*NODE, INPUT=cubes.inp\n1, 0., 0., 0.\n", ":1: .NODE has both INPUT and data lines"),
        (CUBES + "*NSET, NSET=Foot, GENERATE\n4, 1\n", ":18: GENERATE needs first, last"),
        (CUBES + "*NSET, NSET=Foot, GENERATE\n1, 4, 0\n", ":18: GENERATE needs first, last"),
        (CUBES + "*ELSET, ELSET=up\n5\n", "set 'up' names element 5, which does not exist"),
        (
            CUBES + "*NSET, NSET=a, ELSET=b\n",
            ":17: set 'b' of elements is not defined in the file",
        ),
        (
            CUBES + "*INSTANCE, NAME=a\n1., 0., 0.\n",
            ":17: .INSTANCE needs NAME= and PART=, of none",
        ),
        (CUBES + "*NSET, NSET=a\nb\n*NSET, NSET=b\nA\n", "set '[aA]' is a member of itself"),
        (CUBES + "*NSET, NSET=a, INSTANCE=i\n1\n", ":17: .NSET: there is no instance 'i' before"),
        (CUBES + "*NGEN\n1, 5\n", ":17: .NGEN is not supported"),
        (CUBES.replace("*NODE", "*NODE, SYSTEM=C"), ":1: .NODE, SYSTEM: rectangular"),
        ("*INCLUDE, INPUT=none.inc\n", "none.inc: cannot be read"),
        ("*INCLUDE, INPUT=cubes.inp\n", "nested at most ten deep"),
    ],
)
def test_wrong_files(tmp_path, capsys, text, message):
    with pytest.raises(Refused, match=message):
        read_text(tmp_path, capsys, text)


def test_empty_set_is_left_out(tmp_path, capsys):
    _, _, sets, warnings = read_text(tmp_path, capsys, CUBES + "*NSET, NSET=none\n")
    assert set(sets) == {"tissue"} and "dropped set 'none': it has no node" in warnings


def test_what_is_written_is_read_again(tmp_path, capsys):
    """Bit-identical: these coordinates fit into the available characters."""
    points = POINTS / 3
    names = {"foot": [0, 1], "Fuß, left": [3], "2nd": list(range(12))}
    mesh = HexMesh(points, CELLS, {name: np.array(nodes) for name, nodes in names.items()})
    lines = abaqus_writer.mesh_lines(mesh)
    found, cells, sets, warnings = read_text(tmp_path, capsys, "\n".join(lines))
    assert (found == points).all() and (cells == CELLS).all() and sets == names and not warnings
    assert max(map(len, lines)) <= 80


@pytest.mark.parametrize("names", [['a"b'], ["a\nb"], ["x" * 81], ["foot", "Foot"]])
def test_names_that_cannot_be_written(names):
    mesh = HexMesh(POINTS, CELLS, {name: np.array([0]) for name in names})
    with pytest.raises(InputError, match="names? in .inp"):
        abaqus_writer.mesh_lines(mesh)
