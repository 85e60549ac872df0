"""VTK's unstructured grids as meshio and VTK write them, and damaged ones."""

import base64
import locale
import sys

import h5py
import meshio
import numpy as np
import pytest
from meshes import CELLS, POINTS, Refused, read, run, write

SETS = {
    "foot": np.array([1] * 4 + [0] * 8, dtype=np.uint8),
    "Fuß 2": np.array([0] * 11 + [1], dtype=np.int64),
    "ids": np.arange(12),
    "weight": np.ones(12),
}


@pytest.mark.parametrize("version", ["0.1", "1.0", "2.0", "2.3"])
@pytest.mark.parametrize("compressor", [None, "vtkZLib", "vtkLZ4", "vtkLZMA"])
def test_what_vtk_writes(tmp_path, capsys, version, compressor):
    """Debian's VTK writes the file, in each of its modes; newer ones write newer versions."""
    pytest.importorskip("vtkmodules")
    from vtkmodules import vtkIOCore, vtkIOXML

    reader = vtkIOXML.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(write(tmp_path / "own.vtu", POINTS / 3, point_data=SETS)))
    for mode, encoded in ((0, 0), (1, 0), (2, 0), (2, 1)):
        writer = vtkIOXML.vtkXMLUnstructuredGridWriter()
        writer.SetInputConnection(reader.GetOutputPort())
        writer.SetDataMode(mode)
        writer.SetEncodeAppendedData(encoded)
        own = compressor and getattr(vtkIOCore, compressor + "DataCompressor")()
        writer.SetCompressor(own)
        writer.SetBlockSize(128)
        writer.SetFileName(str(tmp_path / "a.vtu"))
        writer.Write()
        data = (tmp_path / "a.vtu").read_bytes()
        head, _, tail = data.partition(b'UnstructuredGrid" version="')
        new = head + b'UnstructuredGrid" version="' + version.encode() + tail[tail.index(b'"') :]
        (tmp_path / "a.vtu").write_bytes(new)
        points, cells, sets, warnings = read(capsys, tmp_path / "a.vtu")
        assert np.allclose(points, POINTS / 3, rtol=0, atol=1e-10 if mode == 0 else 0)
        assert (cells == CELLS).all() and not warnings
        assert sets == {"foot": [0, 1, 2, 3], "Fuß 2": [11]}


@pytest.mark.parametrize("kind", [1, 2])
@pytest.mark.parametrize("version", [42, 51])
def test_what_vtk_writes_in_its_legacy_form(tmp_path, capsys, version, kind):
    """As text and binary."""
    pytest.importorskip("vtkmodules")
    from vtkmodules import vtkIOLegacy, vtkIOXML

    reader = vtkIOXML.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(write(tmp_path / "own.vtu", POINTS / 3, point_data=SETS)))
    writer = vtkIOLegacy.vtkUnstructuredGridWriter()
    writer.SetInputConnection(reader.GetOutputPort())
    writer.SetFileVersion(version)
    writer.SetFileType(kind)
    writer.SetFileName(str(tmp_path / "a.vtk"))
    before = locale.setlocale(locale.LC_ALL)
    writer.Write()  # in the locale C, which it leaves behind
    locale.setlocale(locale.LC_ALL, before)
    points, cells, sets, warnings = read(capsys, tmp_path / "a.vtk")
    assert np.allclose(points, POINTS / 3, rtol=0, atol=1e-5 if kind == 1 else 0)
    assert (cells == CELLS).all() and not warnings
    assert sets == {"foot": [0, 1, 2, 3], "Fuß 2": [11]}


def test_a_compressor_without_its_package_is_named(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "lz4.block", None)
    text = write(tmp_path / "a.vtu", compression="zlib").read_text()
    (tmp_path / "a.vtu").write_text(text.replace("vtkZLib", "vtkLZ4"))
    with pytest.raises(Refused, match="a.vtu: is compressed with lz4, which needs package python3"):
        read(capsys, tmp_path / "a.vtu")


def test_a_kind_of_cells_that_has_no_name_here_is_refused_by_number(tmp_path, capsys):
    path = write(tmp_path / "a.vtu", binary=False)
    before, types = path.read_text().split('Name="types"')
    path.write_text(before + 'Name="types"' + types.replace("12\n12", "12\n42"))
    with pytest.raises(Refused, match="1 of type 'VTK's type 42', besides 1 hex"):
        read(capsys, path)


@pytest.mark.parametrize(
    "kind, cells, message",
    [
        ("tetra", [[0, 1, 2, 4]], "1 of type 'tetra', besides 0 hexahedra"),
        ("wedge", [[0, 1, 2, 4, 5, 6]] * 2, "2 of type 'wedge'"),
        ("quad", [[0, 1, 2, 3]], "has only quad; eight-node hexahedra are required"),
        (
            "hexahedron",
            [[0, 1, 2, 3, 4, 5, 6, 12]],
            "element 0 names node 12, which does not exist",
        ),
        (
            "hexahedron",
            [[0, 1, 2, 3, 4, 5, 6, -1]],
            "element 0 names node -1, which does not exist",
        ),
    ],
)
def test_other_cells_are_refused(tmp_path, capsys, kind, cells, message):
    with pytest.raises(Refused, match=message):
        read(capsys, write(tmp_path / "a.vtu", cells=cells, kind=kind))


def test_several_pieces_are_refused(tmp_path, capsys):
    path = write(tmp_path / "a.vtu", binary=False)
    text = path.read_text()
    piece = text[text.index("<Piece") : text.index("</Piece>") + 8]
    path.write_text(text.replace(piece, piece + piece))
    with pytest.raises(Refused, match="has 2 pieces; one is required"):
        read(capsys, path)


@pytest.mark.parametrize(
    "content", [b"", b"<VTKFile>", b"\0\1\2", b"<a/>", base64.b64encode(b"x" * 99)]
)
def test_files_without_a_grid(tmp_path, capsys, content):
    (tmp_path / "a.vtu").write_bytes(content)
    with pytest.raises(Refused, match="a.vtu: cannot be read as a .vtu grid: "):
        read(capsys, tmp_path / "a.vtu")


def test_the_line_of_an_array_is_named(tmp_path, capsys):
    text = write(tmp_path / "a.vtu", point_data=SETS, binary=False).read_text()
    lines = text.splitlines()
    at = next(i for i, line in enumerate(lines) if 'Name="ids"' in line)
    lines[at + 3] = "2x"
    (tmp_path / "a.vtu").write_text("\n".join(lines))
    with pytest.raises(
        Refused, match=rf"a.vtu:{at + 1}: cannot .* array 'ids': '2x' is not a whole number"
    ):
        read(capsys, tmp_path / "a.vtu")


@pytest.mark.parametrize(
    "array, old, new, message",
    [
        ("types", "\n12\n12\n", "\n12\n268\n", "'268' is not a number of type uint8"),
        ("connectivity", "\n11\n", "\n1_1\n", "'1_1' is not a whole number"),
        ("connectivity", "\n11\n", "\n9223372036854775807\n", "is not a whole number"),
        ("connectivity", "\n10\n11\n", "\n10-11\n", "'10-11' is not a whole number"),
        ("connectivity", "\n11\n", "\n11.5\n", "'11.5' is not a whole number"),
    ],
)
def test_numbers_that_python_or_a_narrow_type_would_change(
    tmp_path, capsys, array, old, new, message
):
    path = write(tmp_path / "a.vtu", binary=False)
    text = path.read_text().replace('"Int64" Name="types"', '"UInt8" Name="types"')
    head, tail = text.split(f'Name="{array}"')
    assert old in tail
    path.write_text(f'{head}Name="{array}"' + tail.replace(old, new, 1))
    with pytest.raises(Refused, match=f"array '{array}': .*{message}"):
        read(capsys, path)


@pytest.mark.parametrize(
    "data, message",
    [
        (
            {"vtkGhostType": [0, 1]},
            "1 of 2 cells are ghosts or hidden by 'vtkGhostType'; rem",
        ),
        ({"mat": [1, 2], "mat-1": [0, 1]}, "two cell arrays define element set 'mat-1'; rename"),
    ],
)
def test_cell_arrays_that_would_be_misread(tmp_path, capsys, data, message):
    data = {name: [np.array(values, np.uint8)] for name, values in data.items()}
    with pytest.raises(Refused, match=message):
        read(capsys, write(tmp_path / "a.vtu", cell_data=data))


LEGACY = """\
# vtk DataFile Version 3.0
two cubes
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 12 float
{}
CELLS 2 18
8 0 1 2 3 4 5 6 7
8 4 5 6 7 8 9 10 11
CELL_TYPES 2
12
12
POINT_DATA 12
SCALARS left%20foot int
LOOKUP_TABLE default
1 1 1 1 0 0 0 0 0 0 0 0
VECTORS u double
{}
CELL_DATA 2
COLOR_SCALARS shade 1
0.5
0.5
SCALARS label int
3
7
"""
LEGACY = LEGACY.format(*(" ".join(map(str, values.ravel())) for values in (POINTS, POINTS / 8)))


def test_a_legacy_file(tmp_path, capsys):
    """What generated.py lacks: labels, names with spaces, colours, no table, displacements."""
    (tmp_path / "a.vtk").write_text(LEGACY)
    points, cells, sets, warnings = read(capsys, tmp_path / "a.vtk")
    assert (points == POINTS).all() and (cells == CELLS).all() and not warnings
    assert sets == {"left foot": [0, 1, 2, 3]}
    mesh = tmp_path / "converted.h5"
    with h5py.File(mesh) as file:
        assert {name: e[...].tolist() for name, e in file["mesh/element_sets"].items()} == {
            "label-3": [0],
            "label-7": [1],
        }
    answer = tmp_path / "u.h5"
    run(capsys, "displacement", tmp_path / "a.vtk", mesh, answer, "--tolerance", "1e-6")
    with h5py.File(answer) as file:
        assert (file["displacement"][...] == POINTS / 8).all()


@pytest.mark.parametrize(
    "old, new, message",
    [
        ("# vtk", "# VTX", ":1: .* '# vtk DataFile Version N', a title, and ASCII or BINARY must"),
        ("ASCII", "TEXT", "a title, and ASCII or BINARY must come first"),
        ("UNSTRUCTURED_GRID", "POLYDATA", ":4: .*type POLYDATA; UNSTRUCTURED_GRID is required"),
        ("POINTS 12", "POINTS 13", ":5: .*39 numbers are announced, but 'CELLS' is not a n"),
        ("POINTS 12 float", "POINTS 12", ":5: .*'POINTS 12' is incomplete or damaged"),
        ("POINTS 12 float", "POINTS 12 words", ":5: .*type 'words' is unknown"),
        ("POINTS 12", "POINTS 12000000000000", ":5: .*announced, more than the file holds"),
        ("CELLS 2 18", "CELLS 2 17", ":10: .*'11' stands|:7: .*2 cells have 18 numbers"),
        ("8 4 5", "7 4 5", ":7: .*2 cells have 17 numbers; 18 are announced"),
        ("8 4 5", "-8 4 5", ":7: .*negative number of nodes"),
        ("CELL_TYPES 2\n12\n12", "CELL_TYPES 1\n12", "2 cells and 1 types; 1 are required"),
        ("POINT_DATA 12\n", "", ":14: .*array 'left foot' comes before POINT_DATA"),
        ("SCALARS label int\n3\n7", "SCALARS label int\n3", ":23: .*2 numbers are .*cut off"),
        ("VECTORS u", "VECTORS left%20foot", "two arrays are named 'left foot'"),
        ("VECTORS u", "VEKTORS u", ":17: .*'VEKTORS' stands where a keyword is"),
        ("CELL_TYPES 2\n", "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 2\n", ":10: .*one section"),
        ("SCALARS label int\n3", "SCALARS label char\n300", "'300' is not a number of type int8"),
        ("CELLS 2 18", "METADATA\n\nCELLS 2 18", None),
    ],
)
def test_damage_of_a_legacy_file_is_named(tmp_path, capsys, old, new, message):
    assert LEGACY.count(old) == 1 or old == "VECTORS u"
    (tmp_path / "a.vtk").write_text(LEGACY.replace(old, new, 1))
    if message is None:
        assert len(read(capsys, tmp_path / "a.vtk")[0]) == 12
        return
    with pytest.raises(Refused, match="a.vtk" + message if message[0] == ":" else message):
        read(capsys, tmp_path / "a.vtk")


def mesh_file(path):
    with h5py.File(path, "w") as file:
        file["mesh/points"], file["mesh/cells"] = POINTS / 3, CELLS
        file["mesh/sets/foot"], file["mesh/sets/Fuß 2"] = [0, 1, 2, 3], [11]
    return path


def test_what_is_written_is_read_again(tmp_path, capsys):
    run(capsys, "write", mesh_file(tmp_path / "m.h5"), tmp_path / "a.vtu", "--format", "vtu")
    points, cells, sets, warnings = read(capsys, tmp_path / "a.vtu")
    assert (points == POINTS / 3).all() and (cells == CELLS).all() and not warnings
    assert sets == {"foot": [0, 1, 2, 3], "Fuß 2": [11]}


def test_xdmf_is_one_file_with_all_in_it(tmp_path, capsys):
    (tmp_path / "out").mkdir()
    path = tmp_path / "out" / "a.xdmf"
    run(capsys, "write", mesh_file(tmp_path / "m.h5"), path, "--format", "xdmf")
    grid = meshio.xdmf.read(path)
    assert (grid.points == POINTS / 3).all() and (grid.cells[0].data == CELLS).all()
    assert np.flatnonzero(grid.point_data["foot"]).tolist() == [0, 1, 2, 3]
    assert [file.name for file in path.parent.iterdir()] == ["a.xdmf"]
