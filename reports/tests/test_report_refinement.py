"""Error to the truth over time: contents of the plate; broken files are rejected."""

import json

import pytest
from synthetic import Axes

from common.errors import InputError
from sandglass_report.refinement import read_refinement, refinement_plate


def record(seconds, error, **changed):
    found = {"case": "column", "way": "refined", "elements": 300, "seconds": seconds}
    return found | {"error_max": error, "error_rms": 0.1 * error} | changed


def write(tmp_path, *records):
    path = tmp_path / "refinement.json"
    path.write_text(json.dumps({"records": records}))
    return path


def test_a_panel_per_case_and_a_line_per_way_in_the_order_of_elements(tmp_path):
    records = (
        record(4.0, 0.01, elements=900),
        record(0.75, 0.02),
        record(0.5, 0.02),
        record(0.25, 0.03, way="uniform", residual=1e-8),
        record(0.125, 0.04, way="uniform", residual=1e-3),
        record(1.0, 0.05, case="twist"),
    )
    plate = refinement_plate(read_refinement(write(tmp_path, *records)))
    column, twist = plate.panels
    for panel, expected in (
        (column, [([0.25], [0.03]), ([0.125], [0.04]), ([0.5, 4.0], [0.02, 0.01])]),
        (twist, [([], []), ([], []), ([1.0], [0.05])]),
    ):
        axes = Axes()
        panel.draw(axes)
        assert axes.lines == expected
    assert "uniform: 3 % in 0.25 s" in column.alt and "refined: 1 % in 4 s" in column.alt


@pytest.mark.parametrize(
    "broken",
    [{"way": "other"}, {"case": 1}, {"seconds": "1"}, {"error_max": None}],
    ids=lambda changed: next(iter(changed)),
)
def test_a_broken_file_is_rejected(tmp_path, broken):
    with pytest.raises(InputError, match="refinement.json"):
        read_refinement(write(tmp_path, record(1.0, 0.1) | broken))
