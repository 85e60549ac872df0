"""VTK's unstructured grids as meshio and VTK write them, and damaged ones."""

import base64
import sys

import h5py
import meshio
import numpy as np
import pytest
from meshes import CELLS, POINTS, Refused, damaged, read, run, write

from common.hexahedron import LEXICOGRAPHIC

SETS = {
    "foot": np.array([1] * 4 + [0] * 8, dtype=np.uint8),
    "Fuß 2": np.array([0] * 11 + [1], dtype=np.int64),
    "ids": np.arange(12),
    "weight": np.ones(12),
}


@pytest.mark.parametrize(
    "options",
    [{"binary": False}, {"compression": None}, {"compression": "zlib"}, {"compression": "lzma"}],
)
def test_encodings(tmp_path, capsys, options):
    path = write(tmp_path / "a.vtu", POINTS / 3, point_data=SETS, **options)
    points, cells, sets, warnings = read(capsys, path)
    # Text has eleven digits.
    assert np.allclose(points, POINTS / 3, rtol=0, atol=1e-10 if "binary" in options else 0)
    assert (cells == CELLS).all() and not warnings
    assert sets == {"foot": [0, 1, 2, 3], "Fuß 2": [11]}


def test_voxels_have_the_corners_of_an_image(tmp_path, capsys):
    path = write(tmp_path / "a.vtu", cells=CELLS[:, LEXICOGRAPHIC], binary=False)
    before, types = path.read_text().split('Name="types"')
    path.write_text(before + 'Name="types"' + types.replace("12\n12", "11\n11"))
    points, cells, _, warnings = read(capsys, path)
    assert (points == POINTS).all() and (cells == CELLS).all() and not warnings


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
    "kind, cells, told",
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
def test_other_cells_are_refused(tmp_path, capsys, kind, cells, told):
    with pytest.raises(Refused, match=told):
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
def test_what_is_no_grid(tmp_path, capsys, content):
    (tmp_path / "a.vtu").write_bytes(content)
    with pytest.raises(Refused, match="a.vtu: cannot be read as a .vtu grid: "):
        read(capsys, tmp_path / "a.vtu")


@pytest.mark.parametrize(
    "options", [{"binary": False}, {"compression": None}, {"compression": "zlib"}]
)
def test_whatever_happens_to_a_file_it_is_read_or_refused(tmp_path, capsys, options):
    data = write(tmp_path / "a.vtu", point_data=SETS, **options).read_bytes()
    for content in damaged(data, 61, 100, seed=5):
        (tmp_path / "b.vtu").write_bytes(content)
        try:
            run(capsys, "mesh", tmp_path / "b.vtu", tmp_path / "out.h5")
            assert len(content) > len(data) - 20, "cut off, and not seen"
        except Refused as told:
            assert "b.vtu" in str(told)


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
