"""Truths: their meshes, their file, and refused input."""

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
    """Except for two whose sides fold too far: theirs are of an earlier kind (README)."""
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
    monkeypatch.setitem(truth.GRADINGS, name, truth.Grading({"root": (2, 3, 4)}, whole=1))
    assert truth.main([name, "-o", str(tmp_path / "truth.h5")]) == 0
    points, displacement, found = read_reference(tmp_path / "truth.h5")
    _, expected, attributes = read_reference(path_of("truth", name))
    distance, _ = relative_errors(displacement, expected, attributes["largest_imposed"])
    # The error bar holds, and is not much too long.
    bars = found["own_error_max"] + attributes["own_error_max"]
    assert 0.5 * bars < distance < bars
    assert found["own_error_max"] < 0.01
    assert found["element"] == "P2-P1" and found["mirror_planes"] == "y"
    assert found["own_error_note"].startswith("inside 0.0")
    assert "edges: Richardson's extrapolation of 3 meshes" in found["own_error_note"]
    assert found["own_error_note"].endswith(": measured")


def test_a_bar_adds_up_edges_and_inside():
    limit = np.ones((2, 3))
    far, near = ([limit * (1 + c / 2**n) for n in range(3)] for c in (0.4, 0.1))
    edges = truth.error_bar([far, near], None, 1.0)
    # Halved from mesh to mesh: the last difference remains, 0.1 and 0.025 in each component.
    assert edges["own_error_max"] == pytest.approx(0.125 * 3**0.5)
    assert edges["own_error_note"].startswith("edges alone: ")
    both = truth.error_bar([far, near], np.array([[0.03, 0, 0], [0, 0, 0]]), 1.0)
    assert both["own_error_max"] - edges["own_error_max"] == pytest.approx(0.04)
    assert both["own_error_rms"] - edges["own_error_rms"] == pytest.approx(0.04 / 2**0.5)


def test_answers_are_kept_and_mixed(tmp_path):
    name = "ellipsoid-touch"
    grading = truth.Grading(
        {"indenter": (1, 0, 1), "support": (0, 1, 1)}, starts={1: [], 2: [0, 1]}, inside=None
    )
    one, other = (truth.Answer(name, grading, level, [], tmp_path) for level in (0, 1))
    again = truth.Answer(name, grading, 1, [], tmp_path)
    assert (again.field == other.field).all() and again.facts == other.facts
    both = truth.Answer(name, grading, 2, [one, other])
    assert both.facts["load_steps"] == 1  # the mixture is near enough
    share = both._share(one, other)
    assert share.min() == 0 and share.max() == 1
    upper, lower = (both.problem.mesh.points[:, 2] * sign > 0.06 for sign in (1, -1))
    assert share[upper].min() > 0.8 and share[lower].max() < 0.2


def test_wrong_input(tmp_path, capsys):
    assert truth.main(["colum"]) == 2
    assert "did you mean 'column'?" in capsys.readouterr().err
    assert truth.main(["column", "-o", str(tmp_path / "no" / "truth.h5")]) == 2
    assert "cannot be written" in capsys.readouterr().err
    assert truth.main(["column", "twist", "-o", "truth.h5"]) == 2
    assert "one file for 2 cases" in capsys.readouterr().err
    with pytest.raises(InputError, match="has no meshes"):
        truth.make_truth("bar-wave", tmp_path / "truth.h5")
