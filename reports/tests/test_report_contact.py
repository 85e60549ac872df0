"""The plate of the cost of contact; broken files are rejected."""

import json

import pytest
from synthetic import Axes

from common.errors import InputError
from sandglass_report.contact import contact_plate, read_contact
from sandglass_report.style import Palette

PALETTE = Palette(("tl-perturbation", "tl-full"))


def record(across, operations, error, **changed):
    found = {"method": "tl-perturbation", "across": across, "penalty": None}
    return found | {"operations": operations, "error": error} | changed


def write(tmp_path, *records):
    path = tmp_path / "contact_cost.json"
    path.write_text(json.dumps({"records": records}))
    return path


def test_a_line_per_method_over_meshes_and_per_mesh_over_penalties(tmp_path):
    records = (
        record(8, 4e9, 0.01),
        record(4, 1e9, 0.02),
        record(4, 2e9, 0.03, method="tl-full"),
        record(8, None, None, method="tl-full"),
        record(4, 3e9, 0.5, method="unknown"),
        record(4, 2e9, 0.02, penalty=30),
        record(4, 1e9, 0.25, penalty=1),
        record(8, 5e9, 0.2, penalty=1),
    )
    plate = contact_plate(read_contact(write(tmp_path, *records)), PALETTE)
    lines = []
    for panel in plate.panels:
        axes = Axes()
        panel.draw(axes)
        lines.append(axes.lines)
    assert lines[0] == [([1.0, 4.0], [0.02, 0.01]), ([2.0], [0.03])]
    assert lines[1] == [([1.0, 2.0], [0.25, 0.02]), ([5.0], [0.2])]
    assert "8 across: tl-perturbation 1 % for 4" in plate.panels[0].alt
    assert "1 on 4: 25 % for 1" in plate.panels[1].alt


@pytest.mark.parametrize("broken", [{"across": 4.5}, {"error": "1"}, {"operations": None}])
def test_a_broken_file_is_rejected(tmp_path, broken):
    with pytest.raises(InputError, match="contact_cost.json"):
        read_contact(write(tmp_path, record(4, 1e9, 0.1) | broken))
