"""Results of other programs on the page: the entries of ours to compare with, and the marks."""

import json

import pytest

from common.errors import InputError
from common.program import ROOT
from sandglass_report.interactive import chart_data
from sandglass_report.style import Palette
from sandglass_report.submissions import read_submissions

ENTRY = {
    "schema": 1,
    "program": "Other",
    "version": "1",
    "element": "H8",
    "precision": "float",
    "build": "native, GCC",
    "machine": "CPU",
    "case": "column",
    "mesh_hash": "0123456789abcdef",
    "displacement": "0" * 64,
    "errors": {"golden": {"max": 0.01, "rms": 0.005}},
    "ns_per_element_step": 120.0,
    "time_step": 2e-3,
    "seconds_to_rest": 3.0,
    "submitted_by": "us",
    "date": "2026-11-25",
}

OWN = {"processor": "CPU", "version": "1.0.0", "revision": "abc"}


def ours(element, error, ns, **changed):
    """An entry of Sandglass."""
    errors = {"golden": {"max": error, "rms": error / 2}}
    own = {"program": "Sandglass", "element": element, "errors": errors, "build": "GCC"}
    return ENTRY | own | {"ns_per_element_step": ns, "time_step": 1e-3} | changed


def read(folder, *entries):
    """The submissions of a folder with these entries."""
    for i, entry in enumerate(entries):
        (folder / f"{i}.json").write_text(json.dumps(entry))
    return read_submissions(folder)


def test_the_cheapest_of_ours_that_is_as_accurate_is_compared_with(tmp_path):
    found = read(
        tmp_path,
        ENTRY,
        ours("cheap", 0.02, 5.0),
        ours("costly", 0.0001, 40.0),
        ours("right", 0.0104, 20.0, seconds_to_rest=0.5),
        ours("elsewhere", 0.0001, 1.0, machine="another"),
        ours("another case", 0.0001, 1.0, case="twist"),
    )
    nearest = found[0].nearest
    assert (nearest.element, nearest.as_good) == ("right", True)
    # 120 / 20; with steps twice as long half of that per second; 3 / 0.5.
    assert (nearest.step, nearest.simulated, nearest.rest) == (6.0, 3.0, 6.0)
    assert nearest.in_words().startswith("6.0 times per step, 3.0 times per simulated second")
    assert [s.label for s in found[1:5]] == [
        "Sandglass cheap",
        "Sandglass costly",
        "Sandglass elsewhere",
        "Sandglass right",
    ]
    assert all(s.nearest is None for s in found[1:])


def test_if_none_is_as_accurate_the_most_accurate_is_compared_with_and_marked(tmp_path):
    better = ENTRY | {"errors": {"golden": {"max": 0.001, "rms": 0.0005}}, "time_step": None}
    nearest = read(tmp_path, better, ours("a", 0.02, 5.0), ours("b", 0.01, 60.0))[0].nearest
    assert (nearest.element, nearest.as_good, nearest.step) == ("b", False, 2.0)
    assert nearest.simulated is None
    assert nearest.in_words().endswith("of b (float), which is less accurate")


def test_without_ours_on_the_machine_there_is_nothing_to_compare_with(tmp_path):
    (found,) = read(tmp_path, ENTRY)
    assert found.nearest is None
    assert found.as_point(100, OWN).finding == "nothing of ours to compare with"


def test_a_point_of_the_chart(tmp_path):
    point = read(tmp_path, ENTRY, ours("a", 0.01, 60.0))[0].as_point(100, OWN)
    assert point.step == pytest.approx(12e-6) and point.simulated == pytest.approx(6e-3)
    assert point.equilibrium == 3.0 and point.error("golden", "max") == 0.01
    assert point.measured_by == "results/0.json: native, GCC; CPU"
    data = chart_data([], Palette(("a",)), [point])
    assert data["methods"]["Other H8"]["symbol"] == "star" and not data["fronts"]
    assert data["points"][0]["method"] == "Other H8" and not data["points"][0]["fails"]
    assert data["points"][0]["group"] == "Other"


@pytest.mark.parametrize(
    ("version", "machine", "elsewhere"),
    [
        ("1.0.0 (abc)", "CPU, one thread", ""),
        ("1.0.0 (abc)", "Other CPU", "Other CPU, Sandglass 1.0.0 (abc)"),
        ("0.1.0 (old)", "CPU, one thread", "CPU, one thread, Sandglass 0.1.0 (old)"),
    ],
)
def test_a_star_leads_only_if_timed_on_this_machine_with_this_revision(
    tmp_path, version, machine, elsewhere
):
    """Of another program, the revision is that of ours in the same run."""
    mine = ours("a", 0.01, 60.0, version=version, machine=machine)
    points = [s.as_point(100, OWN) for s in read(tmp_path, ENTRY | {"machine": machine}, mine)]
    assert [p.elsewhere for p in points] == 2 * [elsewhere]
    data = chart_data([], Palette(("a",)), points)
    assert bool(data["fronts"]) == (not elsewhere)


def test_without_ours_beside_it_a_star_leads_nothing(tmp_path):
    assert read(tmp_path, ENTRY)[0].as_point(100, OWN).elsewhere == "CPU"


def test_an_entry_that_breaks_the_schema_is_rejected(tmp_path):
    with pytest.raises(InputError, match="0.json: precision: 'half' is not one of"):
        read(tmp_path, ENTRY | {"precision": "half"})


def test_stored_entries_are_shown():
    found = read_submissions(ROOT / "results")
    others = {s.entry["program"] for s in found if not s.ours}
    assert {"NiftySim", "OpenRadioss", "FEBio"} <= others
    for one in found:
        assert one.ours or one.nearest  # each was measured in turn with ours
