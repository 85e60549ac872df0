"""The plates of the experiment and of identified stiffnesses; broken files are rejected."""

import dataclasses
import json

import pytest
from synthetic import Axes, DataSet

from common.errors import InputError
from sandglass_report.experiment import experiment_plate
from sandglass_report.identified import identified_plate, read_identified
from sandglass_report.style import Palette
from sandglass_report.tips import tip_tables
from sandglass_report.verdicts import _tips

PALETTE = Palette(("tl-none", "tl-full"))


def tips(method, ratio, **changed):
    (tip,) = _tips("here", DataSet.tip(method, ratio))
    return dataclasses.replace(tip, **{"scatter": 0.1, "golden": -2.2} | changed)


def test_measured_values_have_a_plate_and_no_table():
    all_tips = (
        tips("tl-none", 1.05),
        tips("tl-full", 0.5),
        tips("tl-none", 1.02, family="swing", of="period", golden=None),
    )
    plate = experiment_plate(all_tips, PALETTE)
    assert [panel.title for panel in plate.panels] == ["beam", "swing"]
    assert "Not drawn, more than 30 % off: tl-full." in plate.note
    assert "Golden: short: 1.100" in plate.panels[0].alt and "Golden" not in plate.panels[1].alt
    assert [words for words, _, _ in plate.legend] == ["measured ± scatter", "golden", "tl-none"]
    assert tip_tables(all_tips) == ()
    assert experiment_plate([tips("tl-none", 1.0, scatter=None)], PALETTE) is None


def record(bias, **changed):
    found = {"scene": "bent beam", "elements": [4, 2, 2], "method": "tl-none", "kappa": None}
    return found | {"bias": bias} | changed


def write(tmp_path, *records):
    path = tmp_path / "identified_stiffness.json"
    path.write_text(json.dumps({"records": records}))
    return path


def test_biases_over_meshes_and_kappas(tmp_path):
    records = (
        record(-0.1),
        record(-0.05, elements=[8, 4, 4]),
        record(None, method="tl-full"),
        record(-0.9, kappa=0.1),
        record(0.05, kappa=0.001),
    )
    plate = identified_plate(read_identified(write(tmp_path, *records)), PALETTE)
    over_meshes, over_kappa = plate.panels
    axes = Axes()
    over_meshes.draw(axes)
    assert axes.lines[0] == ([0, 1], [-0.1, -0.05])
    axes = Axes()
    over_kappa.draw(axes)
    assert axes.lines[0] == ([0.001, 0.1], [0.05, -0.6])  # the end of the axis, an arrowhead
    assert ([0.1], [-0.6]) in axes.lines
    assert "tl-none -5.0 %" in over_meshes.alt and "0.1: -90.0 %" in over_kappa.alt


@pytest.mark.parametrize("broken", [{"elements": [1, 2]}, {"bias": "1"}, {"scene": 1}])
def test_a_broken_file_is_rejected(tmp_path, broken):
    with pytest.raises(InputError, match="identified_stiffness.json"):
        read_identified(write(tmp_path, record(0.1) | broken))
