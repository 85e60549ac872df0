"""The page's text about references by a second program; broken files are rejected."""

import json

import pytest

from common.errors import InputError
from common.program import ROOT
from sandglass_report.second import SecondProgram, read_second_program


def write(tmp_path, *records):
    path = tmp_path / "second.json"
    path.write_text(json.dumps({"records": records}))
    return path


def test_the_largest_distance_of_all_cases_that_were_compared(tmp_path):
    one = {"kind": "golden", "case": "a", "program": "SfePy 1", "distance": 1e-13}
    truth = one | {"kind": "truth", "program": "GetFEM"}
    path = write(tmp_path, one, one | {"distance": 2e-12}, one | {"program": "GetFEM"}, truth)
    assert read_second_program(path) == {
        "golden": SecondProgram("GetFEM and SfePy 1", 3, 2e-12),
        "truth": SecondProgram("GetFEM", 1, 1e-13),
    }


@pytest.mark.parametrize(
    "records",
    [
        [{"kind": "truth", "distance": "1", "program": "a"}],
        [{"kind": "truth", "distance": 1.0}],
        [{"distance": 1.0, "program": "a"}],
        [],
    ],
)
def test_a_broken_file_is_rejected(tmp_path, records):
    with pytest.raises(InputError, match="second.json"):
        read_second_program(write(tmp_path, *records))


def test_the_stored_file_is_good():
    found = read_second_program(ROOT / "reference" / "second_program.json")
    assert found.keys() == {"golden"}
    for one in found.values():
        assert one.cases > 10 and one.largest < 1e-9
