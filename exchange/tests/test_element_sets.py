"""Element sets of other programs' files, and labelled images as meshes."""

import h5py
import numpy as np
import pytest
from command_line import sandglass
from meshes import CELLS, DATA, POINTS, write

from common.program import CASES
from common.result_file import last_displacement
from exchange import abaqus_file, abaqus_writer, convert, hdf5_file, vtu_file
from exchange.foreign_mesh import HexMesh, to_hexahedra


def element_sets(path, *options):
    """Those of a file that convert.py has read, as lists."""
    output = path.parent / "mesh.h5"
    assert convert.main(["mesh", str(path), str(output), *options]) == 0
    with h5py.File(output) as file:
        return {name: list(some) for name, some in file["mesh/element_sets"].items()}


def test_physical_volumes(tmp_path):
    path = tmp_path / "a.msh"
    nodes = "\n".join(f"{n} {x} {y} {z}" for n, (x, y, z) in enumerate(POINTS, 1))
    path.write_text((DATA / "cubes.msh.in").read_text().format(nodes=nodes))
    assert element_sets(path) == {"bone": [0], "soft_tissue": [1]}


def test_cell_arrays(tmp_path):
    data = {"stiff": [np.array([0, 1])], "label": [np.array([7, 3])], "size": [np.array([0.5, 1])]}
    path = write(tmp_path / "a.vtu", cell_data=data)
    assert element_sets(path) == {"stiff": [1], "label-3": [1], "label-7": [0]}


def test_what_is_written_is_read(tmp_path):
    mesh = HexMesh(POINTS, CELLS, {"foot": np.arange(4)}, {"upper": np.array([1])})
    vtu_file.write(tmp_path / "a.vtu", mesh, "vtu")
    (tmp_path / "a.inp").write_text("\n".join(abaqus_writer.mesh_lines(mesh)))
    for path, read in ((tmp_path / "a.vtu", vtu_file.read), (tmp_path / "a.inp", abaqus_file.read)):
        again = to_hexahedra(read(path), path, print)
        assert list(again.element_sets["upper"]) == [1] and list(again.sets["foot"]) == [0, 1, 2, 3]


LABELS = np.zeros((3, 2, 2), dtype=np.uint8)
LABELS[1:, 0, :] = 4
LABELS[2, 1, 1] = 9


def test_an_image_is_an_element_for_each_labelled_voxel(tmp_path):
    np.save(tmp_path / "a.npy", LABELS)
    sets = element_sets(tmp_path / "a.npy", "--spacing", "0.5", "1", "2")
    mesh = hdf5_file.read_mesh(tmp_path / "mesh.h5")
    assert len(mesh.cells) == 5 and sets == {"label-4": [0, 1, 2, 3], "label-9": [4]}
    low, high = mesh.points[mesh.cells].min(axis=1), mesh.points[mesh.cells].max(axis=1)
    assert (high - low == (0.5, 1, 2)).all()
    for label, name in ((4, "label-4"), (9, "label-9")):
        assert (low[sets[name]] == np.argwhere(label == LABELS) * (0.5, 1, 2)).all()


@pytest.mark.parametrize(
    "labels, options, message",
    [
        (LABELS, (), "mesh.spacing"),
        (LABELS[0], ("--spacing", "1", "1", "1"), "(nx, ny, nz)"),
        (0 * LABELS, ("--spacing", "1", "1", "1"), "no label other than 0"),
        (LABELS / 3, ("--spacing", "1", "1", "1"), "whole numbers"),
        (np.arange(8000).reshape(20, 20, 20), ("--spacing", "1", "1", "1"), "grey image"),
    ],
)
def test_an_image_that_is_no_segmentation(tmp_path, capsys, labels, options, message):
    np.save(tmp_path / "a.npy", labels)
    assert convert.main(["mesh", str(tmp_path / "a.npy"), str(tmp_path / "b.h5"), *options]) == 2
    assert message in capsys.readouterr().out


@pytest.mark.parametrize(
    "at, value, message",
    [
        (80, "<f4", "should be"),  # the sizes of voxels, which nibabel would repair
        (123, "u1", "code 7 in its header is unknown"),
        (254, "<i2", "sform_code"),
        (42, "<i2", "8 bytes follow its 1 x 2 x 2 voxels: does the header fit the file?"),
        (None, "", "Expected 12 bytes, got 11"),
    ],
)
def test_headers_of_nifti_that_do_not_fit_are_named(tmp_path, capfd, at, value, message):
    nibabel = pytest.importorskip("nibabel")
    image = nibabel.Nifti1Image(LABELS, np.diag([1.0, 2.0, 3.0, 1.0]))
    image.header.set_xyzt_units("mm")
    data = bytearray(image.to_bytes())
    if at is None:
        del data[-1]
    else:
        put = np.array({80: -1, 123: 7, 254: 99, 42: 1}[at], value).tobytes()
        data[at : at + len(put)] = put
    (tmp_path / "a.nii").write_bytes(data)
    code = convert.main(["mesh", str(tmp_path / "a.nii"), str(tmp_path / "b.h5")])
    said = "".join(capfd.readouterr())
    assert code == (0 if at == 42 else 2) and message in said and said.count("\n") == 1, said


@pytest.mark.parametrize(
    "sform, qform, unit, message",
    [
        (None, None, "mm", "has neither sform nor qform, hence no place and no handedness"),
        ((1, 2, 3), (1, 2, 3), "unknown", "the header names no unit of length; mm is assumed"),
        ((1, 2, 3), (1, 2, 2), "mm", "sform, which is used, and qform or pixdim differ by 2 mm"),
        ((1, 2, 6), None, "mm", "sform, which is used, and qform or pixdim differ by 6 mm"),
        ((1, 2, 3), (1, 2, 3), "mm", ""),
        (None, (1, 2, 3), "mm", ""),
    ],
)
def test_what_a_nifti_header_leaves_open_is_warned_of(
    tmp_path, capsys, sform, qform, unit, message
):
    nibabel = pytest.importorskip("nibabel")
    image = nibabel.Nifti1Image(LABELS, np.diag([1.0, 2.0, 3.0, 1.0]))
    image.header.set_xyzt_units(unit)
    for put, sizes in ((image.set_qform, qform), (image.set_sform, sform)):
        put(np.diag([*(sizes or (1, 2, 3)), 1.0]), code=int(sizes is not None))
    image.to_filename(tmp_path / "a.nii")
    assert convert.main(["mesh", str(tmp_path / "a.nii"), str(tmp_path / "b.h5")]) == 0
    said = capsys.readouterr().err
    assert message in said and said.count("\n") == bool(message), said


def test_a_packed_file_is_no_image(tmp_path, capsys):
    (tmp_path / "a.inp.gz").write_bytes(b"")
    assert convert.main(["mesh", str(tmp_path / "a.inp.gz"), str(tmp_path / "b.h5")]) == 2
    assert "is packed; unpack it with gunzip" in capsys.readouterr().out


def test_a_segmentation_is_a_body_of_several_materials(tmp_path):
    """The case stiff-core, whose elements are cubes, from its labels: the same answer."""
    labels = np.ones((6, 6, 12), dtype=np.int16)
    labels[2:4, 2:4, 4:8] = 2
    np.save(tmp_path / "core.npy", labels)
    text = (CASES / "stiff-core.toml").read_text()
    start, end = text.index("[mesh]"), text.index("[[materials]]")
    text = text[:start] + '[mesh]\nfile = "core.npy"\nspacing = [0.01, 0.01, 0.01]\n\n' + text[end:]
    rule = text[text.index("[element_sets]") : text.index("[sets]")]
    text = text.replace(rule, "").replace('"core"', '"label-2"')
    (tmp_path / "case.toml").write_text(text)
    answers = []
    for case, place in (("stiff-core", "a.h5"), (tmp_path / "case.toml", "b.h5")):
        sandglass("run", case, "-m", "tl-mean-dilatation", "-o", tmp_path / place, code=0)
        with h5py.File(tmp_path / place) as file:
            points = file["mesh/points"][...]
        order = np.lexsort(np.round(points, 9).T)
        answers.append(last_displacement(tmp_path / place)[order])
    assert np.abs(answers[0] - answers[1]).max() < 1e-7 * 0.0283  # both stop at a residual of 1e-8
