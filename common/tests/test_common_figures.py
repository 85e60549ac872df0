"""Accuracy figures by hand, hexahedra of known volume, and result files."""

import h5py
import numpy as np
import pytest

from common.accuracy import relative_distances, relative_errors
from common.hexahedron import CORNERS, CUBE, FACES, LEXICOGRAPHIC, boundary_faces, gauss_jacobians
from common.result_file import last_displacement, text_of

STACK = np.vstack([CUBE, CUBE[4:] + [0, 0, 1]]), np.array([range(8), range(4, 12)])  # two of them


def test_figures_of_a_field_made_by_hand():
    reference = np.ones((4, 3))
    u = reference + [[0.3, 0.4, 0.0], [0.0, 0.0, -0.1], [0.0, 0.0, 0.0], [0.0, 0.2, 0.0]]
    assert relative_distances(u, reference, 2.0) == pytest.approx([0.25, 0.05, 0.0, 0.1])
    largest, rms = relative_errors(u, reference, 2.0)
    assert largest == pytest.approx(0.25, rel=1e-15)
    assert rms == pytest.approx(np.sqrt((0.25 + 0.01 + 0.04) / 4) / 2.0, rel=1e-15)


def test_two_cubes_have_ten_faces_that_look_outward():
    """In the order of the cells: all except the top of the lower and the bottom of the upper."""
    points, cells = STACK
    faces = boundary_faces(cells)
    assert (faces == [*cells[0][np.delete(FACES, 1, 0)], *cells[1][FACES[1:]]]).all()
    corners = points[faces]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    outward = corners.mean(axis=1) - points.mean(axis=0)
    assert (np.einsum("ij,ij->i", normals, outward) > 0).all()


def test_every_edge_of_the_faces_is_one_of_the_cube():
    for face in FACES:
        steps = CORNERS[np.roll(face, -1)] - CORNERS[face]
        assert (np.abs(steps).sum(axis=1) == 2).all()


def test_lexicographic_corners_count_in_binary_with_x_fastest():
    assert (CUBE[LEXICOGRAPHIC] @ [1, 2, 4] == np.arange(8)).all()
    assert (LEXICOGRAPHIC[LEXICOGRAPHIC] == np.arange(8)).all()


def test_volumes_of_cubes_and_of_sheared_ones():
    points, cells = STACK
    assert gauss_jacobians(points, cells).sum(axis=0) == pytest.approx([1, 1], rel=1e-14)
    map_of = np.array([[2.0, 0.3, 0.0], [0.0, 0.5, 0.1], [0.7, 0.0, 3.0]])
    found = gauss_jacobians(points @ map_of.T, cells)
    # Affine: the same at all points, an eighth of the volume at each.
    assert found == pytest.approx(np.full((8, 2), np.linalg.det(map_of) / 8), rel=1e-13)


def test_volume_of_a_frustum():
    """The upper face is half as long: V = h/3 (1 + 1/2 + 1/4). A cube would pass with one point."""
    points = CUBE.astype(float)
    points[4:, :2] = 0.25 + 0.5 * points[4:, :2]
    assert gauss_jacobians(points, np.arange(8)[None]).sum() == pytest.approx(1.75 / 3, rel=1e-14)


def test_an_element_turned_inside_out_has_a_negative_volume():
    assert (gauss_jacobians(CUBE * [1, 1, -1], np.arange(8)[None]) < 0).all()


def test_the_last_frame_counts_by_its_number(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for number in (9, 10, 0):
            file[f"frames/{number:04d}/displacement"] = np.full((2, 3), float(number))
    assert (last_displacement(tmp_path / "a.h5") == 10.0).all()


def test_texts_of_either_length_are_texts(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.attrs["fixed"], file.attrs["free"], file.attrs["x"] = np.bytes_("a"), "b", 0.5
        assert [text_of(file.attrs[name]) for name in ("fixed", "free", "x")] == ["a", "b", 0.5]
