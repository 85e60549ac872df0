"""Captions state the runs' findings, and pictures show the answers that captions name."""

import re

import h5py
import numpy as np
import pytest
from synthetic import HASHES
from test_report_sections import section

from sandglass_report.findings import VERBS
from sandglass_report.published import deviation

SUCCESS = VERBS["good"]


def found(data):
    """The finding on the card of the case."""
    card = re.search(r"Found:</span>(.*?)</p>", section(data.make(), "cases"), re.S)[1]
    return card.replace("\u00a0", " ")


@pytest.mark.parametrize("finding", [word for word in VERBS if word != "not supported"])
def test_a_caption_agrees_with_the_verdict(data, finding):
    data.records[1] = data.run("tl-perturbation", 0.0832, kappa=0.0065, auto=True)
    data.records[1]["finding"] = finding
    data.records = data.records[:2]
    data.write_verdicts()
    words = found(data)
    assert re.search(rf"tl-perturbation {VERBS[finding]}: 8.32 % from the golden", words)
    assert (SUCCESS in words) == (finding == "good")
    assert set(re.findall(r"[\d.]+ %", words)) == {"8.32 %"}  # no other number


def test_a_caption_of_a_failed_run_claims_no_error(data):
    data.records[1] |= {"status": "failed: on fire", "finding": "inverted", "golden": None}
    data.records = data.records[:2]
    data.write_verdicts()
    words = found(data)
    assert f"tl-perturbation {VERBS['inverted']}: on fire." in words
    assert "%" not in words and SUCCESS not in words


def test_a_requirement_is_not_what_was_found(data):
    cases = section(data.make(), "cases")
    assert cases.count("leans by 50") == 1
    assert re.search(r"Required:</span> A short column leans by 50", cases)


def test_a_caption_names_the_best_kappa_only_where_it_is_better(data):
    assert "kappas" not in found(data)
    data.records[2] = data.run("tl-perturbation", 0.001, kappa=0.02)
    data.write_verdicts()
    assert "The best of 2 kappas, 0.02, gives 0.100 %." in found(data)


def test_a_caption_counts_findings_and_limits(data):
    data.records[0]["finding"] = "hourglassing"
    data.limits.append(data.limits[0] | {"holds": False})
    data.write_verdicts()
    words = found(data)
    assert "All 3 methods: 1 good, 1 hourglassing, 1 inverted." in words
    assert "1 of the case’s 2 limits BROKEN." in words


def test_a_golden_far_from_the_truth_is_reported(data):
    assert "from the truth" not in found(data)
    data.write_reference("truth", data.answer * [1.0, 1.0, 1.5], element="P2-P1")
    assert "The golden is 40 % from the truth" in found(data)  # 0.5 * 0.4 m over 0.5 m


def test_an_error_above_one_percent_is_good_only_for_a_reason(data):
    data.write_reference("truth", data.answer * [1.0, 1.0, 1.05], element="P2-P1")
    data.records[1] = data.run("tl-perturbation", 0.03, kappa=0.0065, auto=True)
    data.write_verdicts()
    assert "is good, given the golden’s own error of 4.0 %: 3.00 % from" in found(data)


def without_golden(data):
    (data.folder / "reference/golden/column.h5").unlink()


def picture(data):
    """The line below the picture of the case, or the reason why there is none."""
    cases = section(data.make(), "cases")
    return re.search(r'class="(?:shown|quiet)">((?:deformed|No ).*?)</p>', cases)[1]


def test_a_picture_names_the_source_of_its_answer(data):
    assert picture(data) == "deformed: the golden"
    without_golden(data)
    assert picture(data) == "deformed: tl-perturbation, as no golden is stored"


def test_no_other_method_stands_in_for_the_one_whose_errors_are_shown(data):
    without_golden(data)
    data.records = [data.records[0], data.records[3]]  # tl-none alone has a result
    data.write_verdicts()
    assert picture(data).startswith("No picture: neither a golden nor an answer of tl-perturbation")


def moving(data, hashes=HASHES):
    """Makes the case a motion, whose golden has moved farthest in its second frame."""
    case = data.folder / "cases/column.toml"
    case.write_text(case.read_text().replace('"quasi-static"', '"dynamic"'))
    without_golden(data)
    (data.folder / "reference/motion").mkdir()
    with h5py.File(data.folder / "reference/motion/column.h5", "w") as file:
        for number, factor in (("0001", 0.1), ("0002", 0.9), ("0003", -0.4)):
            file[f"displacement/{number}"] = factor * data.answer
        file["times"] = [0.1, 0.2, 0.3]
        for key, value in (hashes | {"element": "Q1-P0", "dolfinx_version": "0.5"}).items():
            file.attrs[key] = value


def test_a_motion_is_shown_where_its_golden_has_moved_farthest(data):
    import hashlib

    moving(data)
    assert "0.200 % from the golden at the worst node and time" in found(data)
    assert picture(data) == "deformed: the golden at 0.20 s, where it has moved farthest"
    provenance = section(data.make(), "provenance")
    shown = hashlib.sha256((0.9 * data.answer).astype("<f8").tobytes()).hexdigest()[:16]
    assert "golden, in motion" in provenance and shown in provenance
    assert "none is stored" not in provenance


def test_a_golden_of_another_motion_is_rejected(data, capsys):
    from make_report import main

    moving(data, HASHES | {"mesh_hash": "another"})
    assert main(data.arguments) == 2
    assert "motion/column.h5: mesh_hash is another" in capsys.readouterr().err


def test_failures_are_counted_and_the_unexpected_ones_named(data):
    page = data.make()
    assert "1 of 3 runs with default settings fail." in page
    assert "Not expected: tl-full on column (&lt;inverted&gt;)." in page
    data.limits.append(data.limits[0] | {"method": "tl-full", "below": None, "above": 0.1})
    data.write_verdicts()
    page = data.make()
    assert "1 of 3 runs with default settings fail, as expected." in page
    assert "These failures are required by cases: tl-full on column." in page
    assert "Not expected" not in page


def test_a_method_that_does_not_support_the_case_has_not_failed(data):
    data.records[3] |= {"status": "failed: choose another method", "finding": None}
    data.write_verdicts()
    page = data.make()
    assert "settings fail" not in page
    assert "Cases that a method does not support: tl-full on column." in page


@pytest.mark.parametrize(
    ("ratio", "words"),
    [
        (0.00044, "99.96 % too small"),
        (0.5, "50 % too small"),
        (0.88, "12 % too small"),
        (1.07, "7.0 % too large"),
        (3.5, "3.5 times the published value"),
        (-0.2, "of the wrong sign"),
    ],
)
def test_a_distance_from_a_published_value_is_no_share_of_it(ratio, words):
    assert deviation(ratio) == words


def test_curves_over_the_truth_have_nothing_else_on_them(data):
    """A value without a truth is not drawn with a published value instead."""
    for elements, to_truth in (("1", None), ("2", 0.7)):
        record = data.tip("tl-full", 0.3, to_truth=to_truth)
        data.published.append(record | {"variants": [elements, "nu0.25"]})
    data.write_verdicts()
    bending = section(data.make(), "bending")
    assert "tl-full: 0.700 at 0.25" in bending and "tl-full: 0.300" not in bending


def test_requirements_come_before_the_chart_and_are_defined_once(data):
    page = data.make()
    assert page.index("What hourglassing is") < page.index('id="chart-head"')
    for word in ("golden", "truth", "kappa"):
        assert len(re.findall(rf"<dt>{word}</dt>", page)) == 1
    assert np.all([f'id="{name}"' in page for name in ("terms", "question")])


@pytest.mark.parametrize(
    ("elements", "seconds", "words"), [(2200, 0.11, "20,000"), (2200, 2.1, "1,000"), (9, 1.0, "9")]
)
def test_elements_in_real_time_take_a_second_per_simulated_second(elements, seconds, words):
    from sandglass_report.headline import in_real_time

    assert in_real_time(elements, seconds) == words
