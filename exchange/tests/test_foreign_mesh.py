"""Which hexahedra are accepted, renumbered or rejected, whatever file they come from."""

import numpy as np
import pytest
from meshes import CELLS, CUBES, POINTS, Refused, read, write

from common.hexahedron import LEXICOGRAPHIC

MIRRORS = ([4, 5, 6, 7, 0, 1, 2, 3], [0, 3, 2, 1, 4, 7, 6, 5])


def volumes(points, cells):
    """By the divergence theorem over the faces' triangles: independent of the code under test."""
    total = np.zeros(len(cells))
    for face in (
        [0, 3, 2, 1],
        [4, 5, 6, 7],
        [0, 1, 5, 4],
        [1, 2, 6, 5],
        [2, 3, 7, 6],
        [3, 0, 4, 7],
    ):
        a, b, c, d = np.moveaxis(points[cells[:, face]], 1, 0)
        for p, q, r in ((a, b, c), (a, c, d)):
            total += np.einsum("ni,ni->n", p, np.cross(q, r)) / 6
    return total


def bent(points):
    """A smooth map of the cubes that is one to one."""
    x, y, z = points.T
    return np.column_stack([x + 0.2 * z * z, y - 0.1 * x * z, z + 0.1 * np.sin(x + y)])


@pytest.mark.parametrize("mirror", MIRRORS)
@pytest.mark.parametrize("which", [[0], [1], [0, 1]])
def test_mirrored_elements_are_turned_round(tmp_path, capsys, mirror, which):
    points, cells = bent(POINTS), CELLS.copy()
    for e in which:
        cells[e] = cells[e][mirror]
    found, turned, _, warnings = read(capsys, write(tmp_path / "a.vtu", points, cells))
    assert (found == points).all()
    assert (np.sort(turned) == CELLS).all()
    assert np.allclose(volumes(points, turned), volumes(points, CELLS), rtol=1e-14)
    listed = ", ".join(map(str, which))
    assert f"{len(which)} of 2 elements had a mirrored node order" in warnings
    assert warnings.strip().endswith(f"renumbered: {listed}")


def test_good_elements_are_left_alone(tmp_path, capsys):
    for shift in range(4):  # any of the numberings that VTK allows
        order = [(i + shift) % 4 for i in range(4)]
        cells = CELLS[:, order + [4 + i for i in order]]
        _, found, _, warnings = read(capsys, write(tmp_path / "a.vtu", bent(POINTS), cells))
        assert (found == cells).all() and not warnings


def test_tangled_elements_are_refused_with_a_hint(tmp_path, capsys):
    with pytest.raises(
        Refused, match=r"2 of 2 elements are tangled.*: 0 at \(0.5, 0.5, 0.5\)"
    ) as error:
        read(capsys, write(tmp_path / "a.vtu", cells=CELLS[:, LEXICOGRAPHIC]))
    assert "they seem to be numbered with x fastest" in str(error.value)
    points = POINTS.copy()
    points[6] = [-0.5, -0.5, 0.5]  # the common corner beyond the opposite one
    with pytest.raises(Refused, match="are tangled") as error:
        read(capsys, write(tmp_path / "a.vtu", points))
    assert "fastest" not in str(error.value)


def test_an_inverted_element_is_not_taken_for_a_mirrored_one(tmp_path, capsys):
    """The upper cube pushed through the lower one: its numbering is right, its position is not."""
    points = POINTS.copy()
    points[8:, 2] = 0.5
    with pytest.raises(Refused, match="elements 0 and 1 lie on the same side of their common face"):
        read(capsys, write(tmp_path / "a.vtu", points))


def test_elements_over_each_other_are_refused(tmp_path, capsys):
    for cells in (CELLS[[0, 1, 0]], [CELLS[0], CELLS[0][[1, 2, 3, 0, 5, 6, 7, 4]]]):
        with pytest.raises(Refused, match="same side of their common face"):
            read(capsys, write(tmp_path / "a.vtu", cells=cells))


def test_a_third_element_on_a_face_is_refused(tmp_path, capsys):
    """It lies on the opposite side of the second, so only the number of elements gives it away."""
    points = np.vstack([POINTS, POINTS[:4] - [0, 0, 1]])
    cells = [*CELLS, [12, 13, 14, 15, 4, 5, 6, 7]]
    with pytest.raises(Refused, match="or share it with a third"):
        read(capsys, write(tmp_path / "a.vtu", points, cells))


def test_flat_elements_are_refused(tmp_path, capsys):
    with pytest.raises(Refused, match="2 of 2 elements are tangled"):
        read(capsys, write(tmp_path / "a.vtu", POINTS * [1, 1, 0]))


def test_ids_of_the_file_are_reported(tmp_path, capsys):
    text = CUBES.replace("\n2, 5, 6, 7, 8, 9, 10, 11, 12", "\n777, 9, 10, 11, 12, 5, 6, 7, 8")
    (tmp_path / "a.inp").write_text(text)
    _, cells, _, warnings = read(capsys, tmp_path / "a.inp")
    assert "renumbered: 777" in warnings and (cells == CELLS).all()
