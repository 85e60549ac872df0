"""The accuracy formulas, by hand and against the solver's own figures."""

import os

import numpy as np
import pytest
from command_line import BINARY

from common.program import ROOT, output_of
from sandglass_report.accuracy import accuracy, ordered_profile
from sandglass_report.verdicts import read_verdicts
from sandglass_report.subject import read_subjects


def test_figures_of_a_field_made_by_hand():
    reference = np.zeros((4, 3))
    u = np.array([[0.3, 0.4, 0.0], [0.0, 0.0, -0.1], [0.0, 0.0, 0.0], [0.0, 0.2, 0.0]])
    found = accuracy(u, reference, unit=2.0, profile=np.array([1, 2]))
    assert found.max == pytest.approx(0.25, rel=1e-15)
    assert found.profile == pytest.approx(0.05, rel=1e-15)
    assert found.rms == pytest.approx(np.sqrt((0.25 + 0.01 + 0.04) / 4) / 2.0, rel=1e-15)


def test_no_profile_gives_no_profile_figure():
    assert accuracy(np.ones((2, 3)), np.zeros((2, 3)), 1.0).profile is None


def test_profile_along_an_axis_is_in_order_of_the_coordinate():
    points = np.array([[0, 0, 2.0], [0, 0, 0.0], [9, 9, 9.0], [0, 0, 1.0]])
    nodes, along = ordered_profile(points, [0, 1, 3], "z")
    assert nodes.tolist() == [1, 3, 0]
    assert along.tolist() == [0.0, 1.0, 2.0]


@pytest.mark.parametrize(
    ("order", "first", "last"), [("around-x", 1, 2), ("around-y", 0, 2), ("around-z", 0, 1)]
)
def test_profile_around_an_axis_is_in_order_of_the_angle(order, first, last):
    angles = np.radians([90.0, -90.0, 0.0, 45.0, -135.0])
    points = np.full((5, 3), 7.0)
    points[:, first] += 2 * np.sin(angles)
    points[:, last] += np.cos(angles)
    # The middle of the line's box must be its centre for the angles to be these.
    points = np.vstack([points, points[2]])
    points[5, last] -= 2
    nodes, along = ordered_profile(points, range(6), order)
    assert nodes.tolist()[:5] == [4, 1, 2, 3, 0]
    assert nodes[5] == 5
    assert along[[1, 2, 4]].tolist() == pytest.approx([-90.0, 0.0, 90.0])
    assert along[5] == pytest.approx(180.0)


@pytest.mark.skipif(not os.path.exists(BINARY), reason="the solver is not built")
def test_figures_are_the_solvers_own(tmp_path):
    """From the solver's displacements, the same formulas must give the solver's figures."""
    verdicts_file, results = tmp_path / "verdicts.json", tmp_path / "results"
    words = ["verify", "column", "--json", verdicts_file, "--results", results]
    output_of(BINARY, *words, allowed=(0, 1), cwd=ROOT)
    verdicts = read_verdicts(verdicts_file)
    (subject,) = read_subjects(verdicts, ROOT / "cases", ROOT / "reference", results)
    compared = 0
    for run in subject.runs:
        u = subject.displacements[run.method, None if run.is_main else run.kappa]
        for kind in ("golden", "truth"):
            stored, reference = getattr(run, kind), getattr(subject, kind)
            if stored is None:
                continue
            nodes = subject.sets[subject.profile_set]
            found = accuracy(u, reference.displacement, subject.unit, nodes)
            for name in ("max", "profile", "rms"):
                assert abs(getattr(found, name) - getattr(stored, name)) < 1e-12, (run.label, name)
                compared += 1
    assert compared > 0
