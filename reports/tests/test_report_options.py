"""The options of the chart on a page of several cases, in a headless Chromium."""

import json
from pathlib import Path

import pytest
from browser import CHROMIUM, Browser
from synthetic import DataSet
from test_report_browser import DRAWN, choose, marks, point_at
from test_report_submissions import ENTRY

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")


def several_cases(folder):
    """A page of four cases: a truth is missing, a profile, a search, and everything."""
    data = DataSet(folder)
    records, text = data.records, (data.folder / "cases/column.toml").read_text()
    for record in records[1:3]:
        record["truth"] = record["golden"] | {"max_relative_error": 30.0}
    moving = {"equilibrium_seconds": None, "evaluations": None, "motion_seconds": 1.0, "steps": 9}
    for name, changed in (("mute", {"golden": None, "finding": None}), ("moving", moving)):
        (data.folder / f"cases/{name}.toml").write_text(text.replace('"column"', f'"{name}"'))
        data.records += [record | {"case": name, "truth": None} | changed for record in records[:3]]
        for path in list((data.folder / "results").glob("column.*")):
            copy = data.folder / f"results/{path.name.replace('column', name, 1)}"
            copy.write_bytes(path.read_bytes())
    for record in data.records:
        if record["case"] == "moving":
            record["golden"] = record["golden"] | {"profile_relative_error": None}
    data.write_verdicts()
    data.make()
    return data.page


EVERY_VIEW = Path(__file__).with_name("every_view.js").read_text(encoding="utf-8").strip()


def test_no_combination_of_options_fails(tmp_path):
    """All options of all cases, among them those without data; with all methods hidden, too."""
    page = several_cases(tmp_path)
    with Browser() as other:
        other.open(page)
        other.until(DRAWN)
        selects, boxes = ["case", "reference", "figure", "cost"], ["own", "double", "curves"]
        found = other.run(f"{EVERY_VIEW}({json.dumps(selects + boxes)})")
        assert found == {"views": 3 * 2 * 3 * 3 * 8, "faults": []}
        other.run("document.querySelector('[data-all=off]').click()")
        assert other.run(f"{EVERY_VIEW}({json.dumps(selects)})")["faults"] == []
        assert other.complaints == []


def disabled(browser):
    """Texts of the options that cannot be chosen."""
    options = "[...document.querySelectorAll('#chart option')].filter((o) => o.disabled)"
    return browser.run(f"{options}.map((o) => o.textContent)")


def test_options_without_data_are_disabled_and_a_choice_returns_with_the_data(tmp_path):
    page = several_cases(tmp_path)
    reference = "document.querySelector('#chart [name=reference]').value"
    with Browser() as other:
        other.open(page)
        other.until(DRAWN)
        assert disabled(other) == []
        choose(other, "reference", "truth")
        choose(other, "case", "moving")
        assert other.run(reference) == "golden"
        assert disabled(other) == [
            "the truth (finer mesh): none for this case",
            "largest error on the profile line: no profile line",
            "to equilibrium: none: a dynamic case",
        ]
        choose(other, "case", "mute")
        assert sum(len(trace) for trace in marks(other)) == 0
        assert "nothing to show" in other.run("document.querySelector('#chart .plot').textContent")
        choose(other, "case", "column")
        assert other.run(reference) == "truth"
        # The truth is 3000 % away: drawn at the edge, with an arrowhead.
        assert {y for trace in marks(other) for _, y in trace} == {10}
        arrows = "document.querySelector('#chart .plot').data.find((t) => t.name === 'beyond').text"
        assert other.run(arrows) == ["▲<br> <br> "]


def test_stars_of_another_machine_lead_nothing_and_share_a_switch(tmp_path):
    data = DataSet(tmp_path)
    for i, element in enumerate(("A", "B")):
        entry = ENTRY | {"element": element, "ns_per_element_step": 0.1}
        entry["errors"] = {"golden": {"max": 0.03 * i + 0.001, "rms": 0.001}}
        data.write(f"submissions/{i}.json", entry)
    data.make()
    headline = "document.querySelector('.answer').textContent"
    shown = "document.querySelectorAll('#chart .scatterlayer .point').length"
    with Browser() as other:
        other.open(data.page)
        other.until(DRAWN)
        assert "Cheapest within 1\u00a0% and 1 s: tl-perturbation" in other.run(headline)
        assert "1 of 2 are within both" in other.run(headline)
        assert other.run(shown) == 4
        (star,) = other.run(
            "[...document.querySelectorAll('[data-method=Other]')].map((b) => b.title)"
        )
        assert star == "CPU"
        assert "timed elsewhere: CPU" in point_at(other, 0.031)[1]
        other.run("document.querySelector('[data-method=Other]').click()")
        assert other.run(shown) == 2
