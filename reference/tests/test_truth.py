"""Truths: their meshes, their file, and what is refused."""

import numpy as np
import pytest

import truth
from case_file import find_case, read_case
from common.accuracy import relative_errors
from common.errors import InputError
from common.program import CASES
from mesh_file import load_case_mesh, make_mesh
from reference_file import path_of, read_reference, stored
from symmetry import expand, halve
from tetrahedra import cut


def test_every_truth_has_meshes():
    """But for two whose sides fold too far: theirs are of an earlier kind (README)."""
    folded = {"block-compression", "cylinder-compression"}
    assert set(stored("truth")) == set(truth.GRADINGS) | folded


def test_a_graded_mesh_is_the_case_with_smaller_elements(tmp_path):
    name = "ellipsoid-touch"
    make_mesh(find_case(CASES, name), tmp_path / "mesh.h5", name)
    mesh, _ = load_case_mesh(read_case(find_case(CASES, name), name), tmp_path / "mesh.h5")
    _, graded = truth.graded_mesh(name, truth.Grading({"indenter": (1,)}), 0)
    n = len(mesh.points)
    assert (graded.points[:n] == mesh.points).all() and len(graded.cells) > len(mesh.cells)
    assert all(
        (one.nodes[:n] == other.nodes).all()
        for one, other in zip(graded.conditions, mesh.conditions, strict=True)
    )
    # The half is whole: its tetrahedra's nodes and their images are those of the hexahedra.
    part, halves = halve(graded)
    assert [half.axis for half in halves] == [1]
    points = expand(halves, cut(part).points[: len(part.points)])
    assert np.abs(points - graded.points).max() < 1e-15  # mirrored: sums of numbers below 0.1


def test_a_coarse_truth_is_near_the_stored_one(tmp_path, monkeypatch):
    name = "bending-1-nu0.49"
    monkeypatch.setitem(truth.GRADINGS, name, truth.Grading({"root": (1, 2, 3)}, whole=1))
    assert truth.main([name, "-o", str(tmp_path / "truth.h5")]) == 0
    points, displacement, found = read_reference(tmp_path / "truth.h5")
    _, expected, attributes = read_reference(path_of("truth", name))
    distance, _ = relative_errors(displacement, expected, attributes["largest_imposed"])
    # Differences of its meshes say how far it is, to a factor of two.
    assert 0 < distance < 2 * found["own_error_max"] + attributes["own_error_max"]
    assert found["own_error_max"] < 0.01
    assert found["element"] == "P2-P1" and found["mirror_planes"] == "y"
    assert found["own_error_note"].startswith("Richardson's extrapolation of 3 meshes")


def test_wrong_input(tmp_path, capsys):
    assert truth.main(["colum"]) == 2
    assert "did you mean 'column'?" in capsys.readouterr().err
    assert truth.main(["column", "-o", str(tmp_path / "no" / "truth.h5")]) == 2
    assert "cannot be written" in capsys.readouterr().err
    assert truth.main(["column", "twist", "-o", "truth.h5"]) == 2
    assert "one file for 2 cases" in capsys.readouterr().err
    with pytest.raises(InputError, match="has no meshes"):
        truth.make_truth("bar-wave", tmp_path / "truth.h5")
