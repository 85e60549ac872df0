"""The sections of the page from synthetic data: their contents, or the reason for a gap."""

import json
import re

import pytest

from common.program import ROOT

from sandglass_report.paper import TIMED_CASE
from sandglass_report.published import _arrowheads

OPTIONAL = "sandglass bench --threads", "sandglass flops", "reports/curves", "sandglass stability"


def section(page, name):
    """The part of the page from the heading with this id to the next one."""
    start = page.index(f'<h2 id="{name}">')
    end = page.find("<h2 id=", start + 1)
    return (page[start : end if end > 0 else None]).replace("\u00a0", " ")


def script(page, name):
    """The JSON of a data block."""
    return json.loads(re.search(rf'<script[^>]* id="{name}">(.*?)</script>', page, re.S)[1])


def test_without_optional_files_the_page_names_the_commands(data):
    page = data.make()
    for command in OPTIONAL:
        assert command in page
    assert "Our counts are missing" in page and "Our times are missing" in page
    assert "The file of claims is missing" in page and "verification/mutants/run.py" in page
    assert "No maps were computed" in page
    assert "missing: its figures are left out" in section(page, "provenance")


def test_a_case_shows_the_errors_of_its_run_where_the_golden_is_no_single_field(data):
    """Such as in motion: errors come from the verdict, and the page reads no golden of motion."""
    (data.folder / "reference/golden/column.h5").unlink()
    cases = section(data.make(), "cases")
    assert 'data-value="0.002"' in cases
    assert "no golden stored" not in cases and "no truth stored" in cases


def test_the_chart_has_the_points_of_runs_and_candidates(data):
    rows = [data.row("tl-perturbation", 3e-6, 0.01, mesh="elements = [1]", elements=3)]
    rows += [data.row("unknown-method", 3e-6, 0.01)]
    data.write("curves/a.json", data.choices(rows))
    found = script(data.make(), "chart-data")
    assert len(found["points"]) == 5  # a method that the verdicts do not know has no colour
    coarser = found["points"][-1]
    assert (coarser["mesh"], coarser["elements"], coarser["step"]) == ("elements = [1]", 3, 3e-6)
    used = {i for positions in found["fronts"].values() for i in positions}
    assert used and max(used) < len(found["points"])


def test_data_blocks_cannot_end_early(data):
    data.records[0]["status"] = "failed: </script><b>"
    data.write_verdicts()
    page = data.make()
    points = script(page, "chart-data")["points"]
    assert "failed: </script><b>" in {p["finding"] for p in points}
    assert "</script><b>" not in page


def test_every_method_has_a_switch_with_its_own_colour_and_glyph(data):
    page = section(data.make(), "chart-head")
    buttons = re.findall(r'data-method="([^"]+)"><i style="color:var\((.*?)\)">(.)</i>', page)
    assert [name for name, _, _ in buttons] == ["tl-none", "tl-perturbation", "tl-full"]
    assert len({(colour, glyph) for _, colour, glyph in buttons}) == 3


def test_tables_of_the_paper_stand_beside_ours(data):
    records = [data.count("tl-perturbation", 360, form="paper"), data.count("tl-perturbation", 100)]
    records += [data.count("ul-perturbation", 250)]
    data.write("flops.json", {"records": records})
    times = {"tl-perturbation": 100.0, "ul-perturbation": 320.0, "ul-enhanced": 410.0}
    text = (data.folder / "cases/column.toml").read_text().replace("column", TIMED_CASE)
    (data.folder / "cases/ellipsoid.toml").write_text(text)
    for method, ns in times.items():
        record = data.run(method, 0.002) | {"case": TIMED_CASE, "ns_per_element_step": ns}
        record["check_ns_per_element_step"] = 0.0
        record["seconds_per_simulated_second"] = 1e-9 * ns * 12 / record["mean_step_seconds"]
        data.records.append(record | {"golden": None, "finding": None})
        name = f"results/{{}}.{method}.h5"
        (data.folder / name.format("column")).rename(data.folder / name.format(TIMED_CASE))
    data.records = [r for r in data.records if r["case"] == TIMED_CASE]
    data.write_verdicts()
    page = section(data.make(), "paper")
    for cell in ("1585", ">360<", ">100<", ">250<", ">2.5<"):  # counts and their ratio
        assert cell in page
    for cell in (">13.7<", ">6.5<", ">0.00120<", ">3.2<", ">4.1<"):  # times and their ratios
        assert cell in page
    assert "missing" not in page


def bending(data):
    """Published records of a cantilever: two methods, two meshes, two ratios."""
    ratios = {("tl-none", 1): 1.2, ("tl-none", 2): 1.02, ("tl-full", 1): 0.3, ("tl-full", 2): 0.6}
    for (method, elements), ratio in ratios.items():
        for nu in ("0.25", "0.499"):
            record = data.tip(method, ratio, to_truth=ratio)
            data.published.append(record | {"variants": [str(elements), f"nu{nu}"]})
    data.write_verdicts()


def test_bending_and_locking_curves(data):
    bending(data)
    page = section(data.make(), "bending")
    for words in ("1 element through", "2 elements through", "ratio 0.25", "ratio 0.499"):
        assert words in page
    assert "tl-full: 0.300 at 0.25, 0.300 at 0.499" in page
    assert "tl-full: 0.300 at 1, 0.600 at 2" in page


def test_a_failed_run_has_no_place_on_a_curve(data):
    bending(data)
    data.published[0] |= {"status": "failed: inverted"}
    data.write_verdicts()
    assert "tl-none: 1.20 at 0.499" in data.make()


OTHERS = (
    {"program": "Other, Q1", "elements": [2, 16], "values": [-1.5, -1.9], "source": "a manual"},
    {"program": "Third", "elements": [], "values": [-2.01], "source": "a thesis"},
)


def published(data):
    """Published records of two methods on two meshes, one of which locks, with other programs."""
    ratios = {("tl-none", "4"): 0.9, ("tl-none", "16"): 0.99}
    ratios |= {("tl-full", "4"): 0.25, ("tl-full", "16"): 0.5}
    for (method, mesh), ratio in ratios.items():
        data.published.append(data.tip(method, ratio, mesh, programs=OTHERS))
    data.write_verdicts()


def test_published_values_stand_beside_ours_in_order_of_the_meshes(data):
    published(data)
    page = section(data.make(), "published")
    assert (
        "beam: z of tip" in page and "1 of 2 methods within 5 % of the published -2, a book" in page
    )
    heads = re.findall(r'<th class="number">(.*?)</th>', page)
    assert heads == ["2", "4", "16", "other"]
    rows = re.findall(r"<tr><td>.*?</tr>", page, re.S)
    texts = [re.sub(r"<.*?>", " ", row).replace("●", "").split() for row in rows]
    assert texts[0] == ["Other,", "Q1", "-1.5", "-1.9"]
    assert texts[1] == ["Third", "-2.01"]
    assert texts[2][-3:] == ["tl-none", "-1.8", "-1.98"]
    assert texts[3][-3:] == ["tl-full", "-0.5", "-1"]
    assert "a manual" in page and "a thesis" in page


def test_a_published_benchmark_names_the_methods_that_fail(data):
    published(data)
    words = section(data.make(), "published")
    unsound = re.search(r"Failed here<.*?</p>", words, re.S)[0]
    assert "tl-full" in unsound and "50 % too small" in unsound and "tl-none" not in unsound
    assert "tl-full: -0.5 at 4, -1 at 16" in words
    data.published[1] |= {"status": "failed: not at rest"}
    data.write_verdicts()
    unsound = re.search(r"Failed here<.*?</p>", section(data.make(), "published"), re.S)[0]
    assert "tl-none" in unsound and "no answer" in unsound


def test_values_beyond_the_edges_are_arrowheads(data):
    from synthetic import Axes

    axes = Axes()
    _arrowheads(axes, [(1, 5.0), (2, 1.0), (4, -9.0)], 0.0, 2.0, "red")
    assert axes.lines == [([1], [2.0]), ([4], [0.0])]
    published(data)
    data.published[0]["values"][0] |= {"computed": -40.0, "ratio": 20.0}
    data.write_verdicts()
    assert "An arrowhead" in section(data.make(), "published")


def test_published_benchmarks_are_not_among_the_tips(data):
    published(data)
    assert "No run had a published value" in section(data.make(), "bending")


def test_forces_of_obstacles_are_in_the_section_of_contact(data):
    data.published.append(data.tip("tl-none", 0.875))
    data.published[0]["values"][0]["of"] = "force"
    data.write_verdicts()
    page = data.make()
    assert "No run had a published value" in section(page, "bending")
    assert "0.875" in section(page, "contact")


def maps(finding="locking"):
    """A document of sandglass stability with one map of two cells."""
    axis = {"name": "load", "meaning": "what it is", "values": [1.0, 2.0]}
    kept = {"method": "tl-none", "y": 0.0, "golden_failed": False, "refused": False}
    cells = [
        kept | {"x": 1.0, "finding": "good", "symptoms": {"error": 0.004}},
        kept | {"x": 2.0, "finding": finding, "symptoms": None},
    ]
    one = {"name": "load", "x": axis, "y": None, "cells": cells}
    return {"case": "column", "limit": 0.01, "revision": "old", "maps": [one]}


def test_failure_maps_are_text_with_titles(data):
    data.write("maps/column.json", maps())
    page = section(data.make(), "maps")
    assert '<td class="good" title="good, 0.400 %">0.4</td>' in page
    assert '<td class="locking" title="locking">L</td>' in page
    assert "load: what it is" in page and "No maps were computed" not in page


def test_pictures_stand_in_for_maps_that_are_not_there(data):
    data.write("maps/column.json", maps())
    (data.folder / "pictures").mkdir()
    for name in ("column.load", "twist.load"):
        (data.folder / f"pictures/stability.{name}.png").write_bytes(b"picture")
    page = section(data.make(), "maps")
    assert page.count("data:image/png;base64,cGljdHVyZQ==") == 1
    assert "twist.load" in page and "column.load<" not in page


def test_evidence_shows_claims_with_their_figures(data):
    (data.folder / "a_test.cpp").write_text("TEST(A, b) {}")
    (data.folder / "claims.toml").write_text(
        '[[claim]]\nsays = "It <works>."\noracle = "arithmetic"\ntests = ["a_test.cpp"]\n'
        'figure = "chart"\nlimits = ["column tl-perturbation auto max_relative_error"]\n'
    )
    page = section(data.make(), "evidence")
    assert "It &lt;works&gt;." in page and "arithmetic" in page and "a_test.cpp" in page
    assert "0.200 %" in page and "≤ 0.3 %" in page
    assert '<a href="#chart-head">' in page


def test_provenance_has_hashes_and_notices_other_revisions(data):
    document = json.loads((data.folder / "verdicts.json").read_text()) | {"revision": "r1"}
    (data.folder / "verdicts.json").write_text(json.dumps(document))
    data.write("bench.json", {"revision": "r2", "records": []})
    data.write("curves/a.json", data.choices([]) | {"revision": "r1"})
    data.write("curves/b.json", data.choices([]) | {"revision": "r1"})
    page = section(data.make(), "provenance")
    assert "0123456789abcdef" in page and "fedcba9876543210" in page
    assert page.count("differs from the runs") == 1
    assert "curves/: 2 files" in page
    data.write_reference("golden", data.answer * 1.0000001)
    with pytest.raises(AssertionError):  # another golden than that of the runs is refused
        data.make()


def test_the_hash_of_a_reference_is_that_of_its_displacements(data):
    import hashlib

    expected = hashlib.sha256(data.answer.astype("<f8").tobytes()).hexdigest()[:16]
    assert expected in section(data.make(), "provenance")


def test_each_link_of_the_navigation_leads_to_a_heading(data):
    page = data.make()
    navigation = re.search(r"<nav class=.*?</nav>", page, re.S)[0]
    shown, folded = (re.findall(r'href="#([^"]+)"', t) for t in navigation.split("<summary>"))
    headings = re.findall(r'<h2 id="([^"]+)"', page)
    assert shown == [name for name in headings if name in shown]
    assert folded == [name for name in headings if name not in shown]
    assert len(shown) <= 8


def test_numbers_on_the_page_begin_with_a_digit():
    """.3 beside 0.3 looks inconsistent, in the page's texts and in stored notes."""
    sources = ROOT / "reports/sandglass_report"
    texts = [path for path in sources.rglob("*.j2") if "style" not in path.name]
    texts += [*sources.glob("*.py"), *sources.rglob("*.js"), *(ROOT / "cases").glob("*.toml")]
    for folder in ("reports/figures", "reports/maps", "results"):
        texts += (ROOT / folder).glob("*.json")
    assert len(texts) > 50
    number = re.compile(r"""(?:^|[\s(~'"])\.\d(?!f)""", re.MULTILINE)
    assert [path.name for path in texts if number.search(path.read_text())] == []


def test_the_page_is_small_without_much_data(data):
    data.make()
    assert data.page.stat().st_size < 4e6  # Plotly packed is two and a half
