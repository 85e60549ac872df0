"""Definitions of the page's numbers: the list names existing fields, and the page follows it."""

import html
import re

import pytest
from test_report_sections import script, section

from sandglass_report.quantities import COSTS, FIGURES, QUANTITIES, RUN_NUMBERS, VERIFY


def test_every_field_of_verify_is_in_its_records(data):
    run, tip = data.run("tl-none", 0.1), data.tip("tl-none", 0.5)
    known = {*run, *run["golden"], *tip, *tip["values"][0], "elements"}
    for name, quantity in QUANTITIES.items():
        if quantity.command == VERIFY:
            fields = re.split(", | × ", quantity.field)
            assert set(fields) <= known, name


def test_names_and_heads_are_unique():
    names = [quantity.name for quantity in QUANTITIES.values()]
    assert len(set(names)) == len(names)
    heads = [QUANTITIES[name].column for name in (*FIGURES, *RUN_NUMBERS)]
    assert len(set(heads)) == len(heads)
    assert all(quantity.definition.endswith(".") for quantity in QUANTITIES.values())


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("mean_step", 0.0003908, "0.391"),
        ("max", 0.0661, "6.61"),
        ("ns", 21.06, "21.1"),
        ("simulated", 0.118979, "0.119"),
        ("evaluations", 39, "39"),
        ("residual", 1.2e-9, "1.2·10⁻⁹"),
        ("hourglass_energy_ratio", 0.0, "0"),
        ("motion", None, ""),
    ],
)
def test_values_are_shown_in_the_unit(name, value, text):
    assert QUANTITIES[name].shown(value) == text


def test_the_page_has_a_table_of_all_numbers(data):
    page = data.make()
    numbers = html.unescape(section(page, "numbers"))
    for quantity in QUANTITIES.values():
        for words in (quantity.name, quantity.definition, quantity.command, quantity.field):
            assert words in numbers
    assert numbers.count("<tr>") == 1 + len(QUANTITIES)
    heads = re.findall(r"<button data-column=\"\d+\">(.*?)</button>", section(page, "runs"))
    expected = 2 * [QUANTITIES[name].head for name in FIGURES]
    expected += [QUANTITIES[name].column for name in RUN_NUMBERS]
    assert heads[4:] == expected
    for name, found in script(page, "chart-data")["costs"].items():
        assert name in COSTS and found["title"] == QUANTITIES[name].name
        assert found["definition"] == QUANTITIES[name].definition


def test_a_row_of_all_runs_has_each_value_under_its_own_head(data):
    record = {name: None for name in ("equilibrium_seconds", "evaluations")}
    data.records[0] |= record | {"motion_seconds": 2.5, "steps": 77, "mean_step_seconds": 7.5e-5}
    data.records[0]["seconds_per_simulated_second"] = 160e-9 * 12 / 7.5e-5
    data.write_verdicts()
    page = section(data.make(), "runs")
    row = re.search(r"<tr[^>]*><td[^>]*>column</td>.*?</tr>", page, re.S)[0]
    cells = [re.sub("<.*?>", "", cell) for cell in re.findall(r"<td.*?</td>", row, re.S)]
    found = dict(zip(RUN_NUMBERS, cells[-len(RUN_NUMBERS) :]))
    assert found == {
        "hourglass_energy_ratio": "1.00",
        "stable_step": "0.100",
        "mean_step": "0.0750",
        "operations": "598",
        "ns": "120",
        "check_ns": "40.0",
        "simulated": "0.0256",
        "evaluations": "",
        "equilibrium": "",
        "steps": "77",
        "motion": "2.50",
        "residual": "1.0·10⁻⁸",
    }
