"""The projection of a surface."""

import numpy as np
import pytest

from sandglass_report.shapes import View


def test_the_front_view_keeps_x_to_the_right_and_z_up():
    flat, near = View(0.0, 0.0).project(np.array([[1.0, 2.0, 3.0]]))
    assert flat[0] == pytest.approx([1.0, 3.0])
    assert near[0] == pytest.approx(-2.0)


def test_a_view_keeps_lengths():
    axes = View(33.0, 21.0).axes()
    assert axes @ axes.T == pytest.approx(np.eye(3))
