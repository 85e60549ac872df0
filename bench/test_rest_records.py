"""Records of times to rest: reading those of the solver, showing and storing them."""

import argparse
import json

import pytest

import rest_records
from errors import DivergenceError, InputError

ENTRY = {
    "case": "block",
    "method": "tl-none",
    "precision": "float",
    "steps": 12,
    "seconds_to_1_percent": 0.125,
    "seconds_to_0_1_percent": 0.25,
    "seconds_to_rest": None,
    "residual": 1e-8,
}

PRINTED = """\
block tl-none : at rest after 1523 steps, residual 9.87e-09
energies (J): strain 0.394954, hourglass 0
wall time 0.485 s, 144.8 ns per element and step
"""


def _stored(tmp_path, document):
    path = tmp_path / "rest.json"
    path.write_text(document if isinstance(document, str) else json.dumps(document))
    return path


def test_records_of_the_solver(tmp_path):
    (found,) = rest_records.read_solver_records(
        _stored(tmp_path, {"version": "1", "records": [{**ENTRY, "kappa": 1}]})
    )
    assert found == {**dict.fromkeys(rest_records.KEYS), "program": "sandglass", **ENTRY}


@pytest.mark.parametrize(
    "document, told",
    [
        ("[", "not a JSON file"),
        ([], "an object is required, not list"),
        ({}, "records = None: a list is required"),
        ({"records": {}}, "records = {}: a list is required"),
    ],
)
def test_damaged_documents(tmp_path, document, told):
    with pytest.raises(InputError, match=f"rest.json: {told}"):
        rest_records.read_solver_records(_stored(tmp_path, document))


@pytest.mark.parametrize(
    "records, told",
    [
        ([ENTRY, 1], "record 1 = 1: an object"),
        ([{"case": "block"}], "record 0: method is missing"),
        ([{**ENTRY, "method": None}], "method = None: a text"),
        ([{**ENTRY, "steps": "12"}], "steps = '12': a number >= 0 or null"),
        ([{**ENTRY, "steps": True}], "steps = True: a number >= 0 or null"),
        ([{**ENTRY, "residual": -1}], "residual = -1: a number >= 0 or null"),
        ([{**ENTRY, "residual": float("nan")}], "residual = nan: a number >= 0 or null"),
    ],
)
def test_damaged_records(tmp_path, records, told):
    with pytest.raises(InputError, match=f"rest.json: .*{told}"):
        rest_records.read_solver_records(_stored(tmp_path, {"records": records}))


def test_missing_records(tmp_path):
    with pytest.raises(InputError, match="none.json: cannot read the records"):
        rest_records.read_solver_records(tmp_path / "none.json")


def test_what_run_printed():
    found = rest_records.read_run("block", "tl-none", PRINTED)
    known = {key: value for key, value in found.items() if value is not None}
    assert known == {
        "program": "sandglass",
        "case": "block",
        "method": "tl-none",
        "precision": "double",
        "steps": 1523,
        "seconds_to_rest": 0.485,
        "residual": 9.87e-09,
    }


@pytest.mark.parametrize("word", ["at rest", "wall time"])
def test_what_run_did_not_print(word):
    with pytest.raises(DivergenceError, match="run block -m tl-none: .*required"):
        rest_records.read_run("block", "tl-none", PRINTED.replace(word, ""))


def test_unknown_figure():
    with pytest.raises(KeyError):
        rest_records.record(speed=1)


def test_table():
    timed = rest_records.record(
        program="CalculiX",
        method="C3D8",
        precision="double",
        seconds_to_rest=5.14404,
        iterations=20,
        error_to_golden_max=0.2418922,
    )
    heading, rule, line = rest_records.table([timed]).splitlines()
    assert len(heading) == len(rule) == len(line)
    cells = dict(zip(*[[c.strip() for c in row.split("|")[1:-1]] for row in (heading, line)]))
    assert {name: cell for name, cell in cells.items() if cell != "-"} == {
        "program": "CalculiX",
        "method": "C3D8",
        "number": "double",
        "to rest, s": "5.14",
        "iterations": "20",
        "to golden, max": "24.2 %",
    }


def test_a_document_is_stored_whole(tmp_path):
    rest_records.write_json(tmp_path / "out.json", {"records": [ENTRY]})
    assert json.loads((tmp_path / "out.json").read_text()) == {"records": [ENTRY]}


def test_what_cannot_be_stored_leaves_the_old_file(tmp_path):
    path = _stored(tmp_path, "old")
    with pytest.raises(ValueError):
        rest_records.write_json(path, {"x": float("nan")})
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]
    with pytest.raises(InputError, match="cannot write"):
        rest_records.write_json(tmp_path / "no" / "out.json", {})


def test_whole_numbers_of_the_command_line():
    assert rest_records.whole_number(1)("1") == 1
    with pytest.raises(argparse.ArgumentTypeError, match="0: must be 1 or more"):
        rest_records.whole_number(1)("0")
