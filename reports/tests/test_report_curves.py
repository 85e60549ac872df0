"""Curves of the adaptive method: contents and units; broken files are rejected."""

import json
import sys

import pytest
from command_line import ran
from synthetic import DataSet

from common.errors import InputError
from common.program import ROOT
from sandglass_report.curves import curve_plate, read_costs
from sandglass_report.style import Palette, solver_methods

SCRIPT = ROOT / "reports" / "make_figures.py"


def row(method, seconds, error=0.01, **changed):
    return DataSet.row(method, seconds, error, **changed)


def write(path, rows, case="block"):
    path.write_text(json.dumps(DataSet.choices(rows, case=case)))
    return path


def test_costs_are_in_steps_of_the_unit_of_their_own_file(tmp_path):
    """Two files of one case are two measurements: each is relative to its own unit."""
    one = write(
        tmp_path / "1", [row("tl-perturbation", 2e-5), row("tl-adaptive", 3e-5, accuracy=0.01)]
    )
    two = write(
        tmp_path / "2", [row("tl-perturbation", 4e-5), row("tl-adaptive", 8e-5, accuracy=0.001)]
    )
    found = read_costs([one, two])["block"]
    costs = [(c.accuracy, cost) for cost, c in found]
    assert costs == [(None, 1.0), (0.01, 1.5), (0.001, 2.0)]


@pytest.mark.parametrize(
    "left_out",
    [
        {"precision": "float"},
        {"mesh": "[2, 2, 2]"},
        {"kappa": 0.01},
        {"seconds": None},
        {"step_size": None},
        {"error": None},
    ],
    ids=lambda changed: next(iter(changed)),
)
def test_other_candidates_are_left_out(tmp_path, left_out):
    shown, hidden = row("tl-perturbation", 1e-5), row("other", 1e-5) | left_out
    found = read_costs([write(tmp_path / "1", [shown, hidden])])["block"]
    assert [c.method for _, c in found] == ["tl-perturbation"]


def test_a_panel_for_each_case_says_its_curve(tmp_path):
    files = [
        write(
            tmp_path / case,
            [row("tl-perturbation", 1e-5), row("tl-adaptive", 2e-5, 0.003, accuracy=0.005)],
            case,
        )
        for case in ("a", "b")
    ]
    plate = curve_plate(read_costs(files))
    assert [panel.title for panel in plate.panels] == ["a", "b"]
    assert all("0.3 % at 2.00" in panel.alt for panel in plate.panels)


@pytest.mark.parametrize(
    "text, message",
    [
        ("", "not a JSON file"),
        ("{}", "reference is missing"),
        (json.dumps(DataSet.choices([{}])), r"rungs\[0\].method is missing"),
        (json.dumps(DataSet.choices([])), "must have a step of tl-perturbation"),
    ],
)
def test_broken_files_are_refused(tmp_path, text, message):
    path = tmp_path / "broken.json"
    path.write_text(text)
    with pytest.raises(InputError, match=f"broken.json: .*{message}"):
        read_costs([path])


def test_the_script_draws_and_refuses(tmp_path):
    file = write(tmp_path / "1", [row("tl-perturbation", 1e-5)])
    call = [sys.executable, SCRIPT, file, "-o", tmp_path]
    outcome = ran(*call)
    assert outcome.returncode == 0, outcome.stderr
    assert (tmp_path / "adaptive.png").stat().st_size > 1000
    outcome = ran(sys.executable, SCRIPT, tmp_path / "none")
    assert outcome.returncode == 2 and "none" in outcome.stderr


def test_colours_follow_the_solvers_list_and_are_those_of_the_page(tmp_path):
    """The page takes the same list from the verdicts."""
    methods = solver_methods()
    assert methods[:3] == ("tl-none", "tl-perturbation", "tl-perturbation-compact")
    assert len(set(methods)) == len(methods)
    rows = [row("tl-adaptive", 1.0), row("tl-perturbation", 1.0)]
    for order in (rows, rows[::-1]):
        plate = curve_plate(read_costs([write(tmp_path / "1", order)]))
        colours = {words: colour for words, colour, _ in plate.legend}
        assert colours == {m: Palette(methods).colour(m) for m in colours}
