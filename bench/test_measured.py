"""What the stored comparisons in bench/measured say, and what the README says of them."""

import json

import pytest

from common.program import ROOT
from peer_table import tables

FILES = sorted((ROOT / "bench/measured").glob("*.json"))
BEGIN, END = "<!-- peers: begin -->\n", "<!-- peers: end -->"


@pytest.fixture(scope="module")
def documents():
    """The stored files."""
    return [json.loads(path.read_text()) for path in FILES]


def rows(documents, kind, program, element):
    """All rows at rest or in motion of an element."""
    found = [
        row
        for document in documents
        for row in document[kind]
        if (row["program"], row["element"]) == (program, element)
    ]
    assert found
    return found


def of_column(documents):
    """Those of the column, whose elements are bricks: lumped masses are the same by every rule."""
    return [document for document in documents if document["case"] == "column"]


def test_the_readme_has_the_table_of_the_stored_files():
    text = (ROOT / "bench/README.md").read_text()
    assert text.split(BEGIN)[1].split(END)[0].strip() == tables(FILES)


def test_every_program_says_where_it_comes_from(documents):
    for document in documents:
        assert document["processor"] and document["sandglass"] and document["build"]
        for program in document["programs"]:
            revision, separator, flags = program["about"].partition(";")
            assert revision and separator and flags


def test_febio_finds_the_golden(documents):
    """Its three-field element is another implementation of Q1-P0; it writes twelve digits."""
    for row in rows(documents, "at_rest", "FEBio", "three-field-solid"):
        assert row["golden"] < 1e-11


def test_febio_moves_as_mean_dilatation(documents):
    """The same element, masses and central differences: what twelve digits leave of a motion."""
    for row in rows(of_column(documents), "in_motion", "FEBio", "three-field-solid"):
        assert row["nearest"]["method"] == "tl-mean-dilatation"
        assert row["nearest"]["difference"] < 1e-10


def test_calculix_moves_as_the_displacement_element(documents):
    """C3D8; it takes the load half a step later, which is of second order in the step."""
    for row in rows(of_column(documents), "in_motion", "CalculiX", "C3D8"):
        assert row["nearest"]["method"] == "tl-full"
        assert row["nearest"]["difference"] < 1e-4


def test_niftysim_at_our_kappa_finds_the_answer_of_the_perturbation_control(documents):
    """Its gradients are those at the centre, which differ from the mean ones on skew elements."""
    for document in documents:
        ours = {row["element"]: row for row in document["at_rest"] if row["precision"] == "double"}
        for row in document["at_rest"]:
            if row["program"] == "NiftySim" and row["element"] != "H8 0.075":
                assert abs(row["golden"] - ours["tl-perturbation"]["golden"]) < 0.01
