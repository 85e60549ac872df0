"""What the page says of the goldens by a second program; broken files are rejected."""

import json

import pytest

from common.errors import InputError
from common.program import ROOT
from sandglass_report.second import SecondGolden, read_second_golden


def write(tmp_path, *records):
    path = tmp_path / "second.json"
    path.write_text(json.dumps({"records": records}))
    return path


def test_the_largest_distance_of_all_cases_that_were_compared(tmp_path):
    one = {"case": "a", "program": "SfePy 1", "distance": 1e-13}
    path = write(tmp_path, one, one | {"distance": 2e-12}, {"case": "b", "reason": "no term"})
    assert read_second_golden(path) == SecondGolden("SfePy 1", 2, 2e-12)


@pytest.mark.parametrize(
    "record", [{"distance": "1", "program": "a"}, {"distance": 1.0}, {"reason": "none"}]
)
def test_a_broken_file_is_rejected(tmp_path, record):
    with pytest.raises(InputError, match="second.json"):
        read_second_golden(write(tmp_path, record))


def test_the_stored_file_is_good():
    found = read_second_golden(ROOT / "reference" / "second_golden.json")
    assert found.cases > 10 and found.largest < 1e-9
