"""Records of times to rest: reading those of the solver, printing and storing them."""

import json

import pytest

import rest_records
from common.errors import ComputationError, InputError

ENTRY = {
    "case": "block",
    "method": "tl-none",
    "precision": "float",
    "evaluations": 12,
    "seconds_to_1_percent": 0.125,
    "seconds_to_0_1_percent": 0.25,
    "seconds_to_rest": None,
    "residual": 1e-8,
}

PRINTED = """\
tl-none, double, stable step 1.1 ms
static equilibrium (stable): 1523 evaluations and 3 of its stability, 0.485 s; residual 9.87e-09
energies (J): strain 0.394954, hourglass 0
"""


def _stored(tmp_path, document):
    path = tmp_path / "rest.json"
    path.write_text(json.dumps(document))
    return path


def test_records_of_the_solver(tmp_path):
    (found,) = rest_records.read_solver_records(
        _stored(tmp_path, {"version": "1", "records": [{**ENTRY, "kappa": 1}]})
    )
    assert found == {**dict.fromkeys(rest_records.KEYS), "program": "sandglass", **ENTRY}


@pytest.mark.parametrize(
    "records, told",
    [
        ({}, "records = {} must be a list"),
        ([ENTRY, 1], r"records\[1\] = 1 must be an object"),
        ([{"case": "block"}], r"records\[0\].method is missing"),
        ([{**ENTRY, "evaluations": "12"}], "evaluations = '12' must be a number or null"),
        ([{**ENTRY, "residual": -1}], "residual = -1 must be >= 0 or null"),
    ],
)
def test_damaged_records(tmp_path, records, told):
    with pytest.raises(InputError, match=f"rest.json: .*{told}"):
        rest_records.read_solver_records(_stored(tmp_path, {"records": records}))


def test_what_run_printed():
    found = rest_records.read_run("block", "tl-none", PRINTED)
    known = {key: value for key, value in found.items() if value is not None}
    assert known == {
        "program": "sandglass",
        "case": "block",
        "method": "tl-none",
        "precision": "double",
        "evaluations": 1523,
        "seconds_to_rest": 0.485,
        "residual": 9.87e-09,
    }


@pytest.mark.parametrize("word", ["static equilibrium ", "residual "])
def test_what_run_did_not_print(word):
    with pytest.raises(ComputationError, match="run block -m tl-none: .*required"):
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
