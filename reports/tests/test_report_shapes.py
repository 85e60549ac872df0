"""The surface of a mesh and its projection."""

import numpy as np
import pytest
from synthetic import box

from sandglass_report.shapes import View, boundary_faces


@pytest.mark.parametrize("size", [(1, 1, 1), (2, 1, 1), (3, 3, 30)])
def test_a_box_has_the_faces_of_its_six_sides(size):
    a, b, c = size
    assert len(boundary_faces(box(a, b, c)[1])) == 2 * (a * b + b * c + c * a)


def test_faces_look_outward():
    points, cells = box(2, 3, 2)
    faces = boundary_faces(cells)
    corners = points[faces]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    outward = corners.mean(axis=1) - points.mean(axis=0)
    assert (np.einsum("ij,ij->i", normals, outward) > 0).all()


def test_the_front_view_keeps_x_to_the_right_and_z_up():
    flat, near = View(0.0, 0.0).project(np.array([[1.0, 2.0, 3.0]]))
    assert flat[0] == pytest.approx([1.0, 3.0])
    assert near[0] == pytest.approx(-2.0)


def test_a_view_keeps_lengths():
    axes = View(33.0, 21.0).axes()
    assert axes @ axes.T == pytest.approx(np.eye(3))
