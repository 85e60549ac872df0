"""Entries of our own comparison, and the README's statements about them."""

import pytest

from common.program import ROOT
from peer_table import AUTHORS, tables
from results.entry import entry_files, read_entry

BEGIN, END = "<!-- peers: begin -->\n", "<!-- peers: end -->"


@pytest.fixture(scope="module")
def measured():
    """Our entries."""
    found = [read_entry(path) for path in entry_files()]
    return [entry for entry in found if entry["submitted_by"] == AUTHORS]


def rows(measured, program, element, case=None):
    """All entries of an element, at least one."""
    found = [
        entry
        for entry in measured
        if (entry["program"], entry["element"]) == (program, element)
        and case in (None, entry["case"])
    ]
    assert found
    return found


def test_the_readme_has_the_tables_of_the_entries(measured):
    text = (ROOT / "bench/README.md").read_text()
    assert text.split(BEGIN)[1].split(END)[0].strip() == tables(measured)


def test_febio_finds_the_golden(measured):
    """Its three-field element is another implementation of Q1-P0; it writes twelve digits."""
    for entry in rows(measured, "FEBio", "three-field-solid"):
        assert entry["errors"]["golden"]["max"] < 1e-11


@pytest.mark.parametrize(
    "program, element, method, most",
    [
        # Same element, masses and central differences: the error of twelve digits in a motion.
        ("FEBio", "three-field-solid", "tl-mean-dilatation", 1e-10),
        # It applies the load half a step later, an effect of second order in the step.
        ("CalculiX", "C3D8", "tl-full", 1e-4),
    ],
)
def test_the_same_element_moves_alike(measured, program, element, method, most):
    """On the column, whose elements are bricks, so that all rules give the same lumped masses."""
    for entry in rows(measured, program, element, "column"):
        assert entry["nearest_motion"]["method"] == method
        assert entry["nearest_motion"]["difference"] < most


def test_niftysim_at_our_kappa_finds_the_answer_of_the_perturbation_control(measured):
    """Its gradients are those at the centre, which differ from the mean ones on skewed elements."""
    for entry in rows(measured, "NiftySim", "H8 0.00649"):
        for ours in rows(measured, "Sandglass", "tl-perturbation", entry["case"]):
            difference = entry["errors"]["golden"]["max"] - ours["errors"]["golden"]["max"]
            assert abs(difference) < 0.01
