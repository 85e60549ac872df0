"""Shared parts of measurements: the output of a static run, tables."""

import json

import pytest

import measuring
from common.errors import ComputationError


def measured(main, folder, *options):
    """Exit code and stored document (None without one) of a script."""
    output = folder / "document.json"
    code = main(["--json", str(output), *options])
    return code, json.loads(output.read_text()) if output.exists() else None


def test_a_search_for_rest(block):
    evaluations, seconds, text = measuring.rest_of(block, "tl-perturbation", "--threads", 1)
    assert evaluations > 3 and seconds > 0 and "static equilibrium" in text


def test_a_program_that_reports_no_equilibrium(block, monkeypatch):
    monkeypatch.setattr(measuring, "output_of", lambda *_: "static equilibrium: soon")
    with pytest.raises(ComputationError, match="block.toml -m tl-none: .*required, .*soon"):
        measuring.rest_of(block, "tl-none")


def test_a_table_is_aligned():
    columns = (("name", "name", str), ("s", "seconds", "{:.3g}".format))
    records = [{"name": "CalculiX", "seconds": 5.14404}, {"name": "tl-none", "seconds": None}]
    assert measuring.table(records, columns).splitlines() == [
        "| name     | s    |",
        "|----------|------|",
        "| CalculiX | 5.14 |",
        "| tl-none  | -    |",
    ]
