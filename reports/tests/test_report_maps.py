"""Failure maps as pictures: every cell is present, and broken files are rejected."""

import json
import subprocess
import sys

import pytest

from common.errors import InputError
from common.program import ROOT
from sandglass_report.maps import OUTCOMES, map_plates, map_texts, outcome, read_maps, words_in

SCRIPT = ROOT / "reports" / "make_figures.py"


def cell(method="tl-none", x=1.0, y=0.3, finding="good", error=0.001, **changed):
    symptoms = None if error is None else {"error": error}
    kept = {"golden_failed": False, "refused": False, "status": "ok", "steps": 1}
    return (
        {"method": method, "x": x, "y": y, "finding": finding, "symptoms": symptoms}
        | kept
        | changed
    )


def document(cells, xs=(1.0, 2.0), ys=(0.3,)):
    axis = {"meaning": "what it is"}
    both = {
        "x": {"name": "load", "values": list(xs)} | axis,
        "y": {"name": "nu", "values": list(ys)} | axis if ys else None,
    }
    maps = [{"name": "load-nu", "cells": cells} | both]
    return {"case": "block", "limit": 0.01, "revision": "r", "maps": maps}


def test_every_outcome_has_a_colour_and_a_letter_of_its_own():
    """The words are the solver's; a new one needs a colour here."""
    header = ROOT / "suite" / "comparison" / "finding.cpp"
    words = [line.split('"')[1] for line in header.read_text().splitlines() if 'return "' in line]
    assert set(words) <= set(OUTCOMES) and len(words) == 8
    assert len({colour for colour, _ in OUTCOMES.values()}) == len(OUTCOMES)
    assert len({letter for _, letter in OUTCOMES.values()}) == len(OUTCOMES)


@pytest.mark.parametrize(
    "error, words",
    [
        (0.0, "0"),
        (9e-6, "0"),
        (0.00123, "0.1"),
        (0.034, "3"),
        (0.256, "26"),
        (0.094, "9"),
        (0.096, "10"),
    ],
)
def test_working_methods_show_their_error_in_percent(error, words):
    assert words_in(cell(error=error)) == words


def test_failures_show_their_letter():
    assert words_in(cell(finding="locking")) == "L"
    assert words_in(cell(finding="inverted", error=None)) == "I"
    failed = cell(finding=None, error=None, golden_failed=True)
    assert outcome(failed) == "the golden fails" and words_in(failed) == "?"
    assert words_in(cell(finding=None, error=None, refused=True)) == "-"


def test_one_panel_for_each_method_that_counts_its_cells():
    cells = [
        cell(m, x, finding=f) for m in ("a", "b") for x, f in ((1.0, "good"), (2.0, "locking"))
    ]
    (plate,) = map_plates(document(cells))
    assert [panel.title for panel in plate.panels] == ["a", "b"]
    assert plate.panels[0].alt.endswith("of 2 cells 1 good, 1 locking")
    assert [words for words, _, _ in plate.legend] == ["good", "L  locking"]


def test_rows_of_a_table_go_down_from_the_largest_y():
    cells = [cell(x=x, y=y, error=0.001 * x * y) for y in (1.0, 4.0) for x in (1.0, 2.0)]
    (text,) = map_texts([document(cells, ys=(1.0, 4.0))])
    (table,) = text.tables
    assert [(y, [words for _, words, _ in row]) for y, row in table.rows] == [
        (4.0, ["0.4", "0.8"]),
        (1.0, ["0.1", "0.2"]),
    ]


def test_kept_maps_look_the_same_and_are_smaller(tmp_path):
    cells = [cell(x=1.0, error=0.00123456789), cell(x=2.0, finding=None, error=None, refused=True)]
    whole = document(cells)
    (tmp_path / "maps.json").write_text(json.dumps(whole))
    script = SCRIPT.parent / "keep_maps.py"
    command = [sys.executable, script, tmp_path / "maps.json", "-o", tmp_path / "kept"]
    assert subprocess.run(command).returncode == 0
    small = read_maps(tmp_path / "kept/block.json")
    assert map_texts([small]) == map_texts([whole])
    assert "steps" not in json.dumps(small) and "0.00123456" not in json.dumps(small)


def test_draws_figures(tmp_path):
    file = tmp_path / "maps.json"
    cells = [cell(x=x, y=0.0) for x in (1.0, 2.0)]
    file.write_text(json.dumps(document(cells, ys=())))
    command = [sys.executable, SCRIPT, file, "-o", tmp_path / "figures"]
    assert subprocess.run(command).returncode == 0
    assert {f.name for f in (tmp_path / "figures").iterdir()} == {
        "stability.block.load-nu.svg",
        "stability.block.load-nu.png",
    }


@pytest.mark.parametrize("text", ["{", "{}", '{"case": "block", "limit": 1, "maps": []}'])
def test_broken_files_are_refused(tmp_path, text):
    file = tmp_path / "maps.json"
    file.write_text(text)
    with pytest.raises(InputError, match="maps.json"):
        read_maps(file)
    outcome = subprocess.run([sys.executable, SCRIPT, file], capture_output=True, text=True)
    assert outcome.returncode == 2 and "maps.json" in outcome.stderr
