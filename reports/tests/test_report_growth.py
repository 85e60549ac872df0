"""How the cost grows: what the plate draws; broken files are rejected."""

import json

import pytest
from synthetic import Axes

from common.errors import InputError
from sandglass_report.growth import growth_plate, read_growth


def record(elements, seconds, **changed):
    found = {"poisson_ratio": 0.49, "elements": elements, "name": "FEniCSx", "seconds": seconds}
    return found | {"evaluations": 7, "iterations": None} | changed


def write(tmp_path, *records):
    path = tmp_path / "growth.json"
    path.write_text(json.dumps({"records": records}))
    return path


def test_a_line_per_program_and_ratio_in_the_order_of_the_meshes(tmp_path):
    records = record(2560, 4.0), record(320, 0.5), record(320, 0.25, poisson_ratio=0.3)
    plate = growth_plate(read_growth(write(tmp_path, *records)))
    seconds, work = plate.panels
    for panel, expected in (
        (seconds, [([320, 2560], [0.5, 4.0]), ([320], [0.25])]),
        (work, [([320, 2560], [7, 7]), ([320], [7])]),
    ):
        axes = Axes()
        panel.draw(axes)
        assert axes.lines == expected
    assert "4 for 2560 elements" in seconds.alt


@pytest.mark.parametrize(
    "broken",
    [
        {"name": "other"},
        {"poisson_ratio": 0.2},
        {"seconds": "1"},
        {"evaluations": None},
        {"iterations": 7},
    ],
    ids=lambda changed: next(iter(changed)),
)
def test_a_broken_file_is_rejected(tmp_path, broken):
    with pytest.raises(InputError, match="growth.json"):
        read_growth(write(tmp_path, record(320, 1.0) | broken))
