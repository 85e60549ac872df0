"""ci/gate reports changes in terminal, Markdown and JUnit, and fails when it must."""

import pytest
from gate import __main__ as command
from gate.compare import BETTER, NEW, NOISY, UNGATED
from gate.interval import FEWEST
from gate_documents import ORIGIN, verdict
from gate_regressions import (
    REGRESSIONS,
    change_error,
    compute_wrong_forces,
    fail_to_rest,
    move_a_byte,
    slow_a_method,
)


def test_what_was_accepted_passes(accepted):
    code, text = accepted.call()
    assert code == 0
    last = text.strip().splitlines()[-1]
    # Status and 2 errors, status and tip; 5 counts; bits; forces, memory and ratios of 27 variants,
    # the twin ratio of 3, and what the 3 paces have: peak, and over plain numbers if of packs.
    assert last == f"gate: passed: {3 + 2 + 5 + 1 + 27 * 3 + 3 + 3 + 2} figures, 0 regressions"


@pytest.mark.parametrize("change", REGRESSIONS, ids=lambda change: change.__name__)
def test_regression_is_told_everywhere(accepted, change):
    area, name, figure, kind = REGRESSIONS[change]
    change(accepted)
    code, text = accepted.call()
    assert code == 1
    (line,) = [row for row in text.splitlines() if f" {name} " in row and f" {figure} " in row]
    assert line.startswith(kind) and f" {area} " in line
    assert "gate: FAILED" in text
    (case,) = accepted.junit().findall(f"./testsuite[@name='{area}']/testcase[@name='{name}']")
    assert f"{figure}: {kind}: " in case.find("failure").text
    markdown = (accepted.path / "out" / "gate.md").read_text()
    assert f"| {kind} | {area} | {name} | {figure} |" in markdown


def test_every_regression_of_every_area_is_tried():
    assert {expected[0] for expected in REGRESSIONS.values()} == {
        area for areas in command.SOURCES.values() for area in areas
    }


def test_improvement_is_told_and_passes(accepted):
    accepted.verdicts["records"][0]["golden"]["max_relative_error"] = 0.009
    accepted.flops["records"][0]["add"] -= 1
    code, text = accepted.call()
    assert code == 0
    assert f"2 {BETTER}" in text.strip().splitlines()[-1]
    (case,) = accepted.junit().findall(
        "./testsuite[@name='accuracy']/testcase[@name='column, tl-full, double']"
    )
    assert BETTER in case.find("system-out").text and case.find("failure") is None


def test_new_records_are_told_and_pass_but_promises_hold_for_them(accepted):
    accepted.verdicts["records"].append(verdict("twist"))
    accepted.bits["records"].append({"name": "twist, tl-full", "differs": ""})
    code, text = accepted.call()
    assert code == 0 and f"3 {NEW}" in text.strip().splitlines()[-1]
    assert "not in the baseline: accept it" in text
    accepted.bits["records"][1]["differs"] = "/frames/0001/displacement differs"
    assert accepted.call()[0] == 1


def test_new_method_on_a_known_machine_is_new(accepted):
    for document in accepted.bench:
        document["records"] += [r | {"method": "ul-new"} for r in document["records"][:1]]
    text = accepted.call()[1]
    # Bytes and the ratio; that forces are right is promised.
    assert f"2 {NEW}" in text.strip().splitlines()[-1] and UNGATED not in text


def test_comes_to_rest_again(folder):
    fail_to_rest(folder)
    folder.accept()
    folder.verdicts["records"][0] = verdict()
    code, text = folder.call()
    assert code == 0 and "comes to rest" in text


def test_where_a_failed_run_stopped_is_chance(folder):
    folder.verdicts["records"][0]["status"] = "failed: not at rest, residual 1.0e-03"
    folder.accept()
    folder.verdicts["records"][0]["golden"]["max_relative_error"] = 0.5
    folder.verdicts["records"][0]["status"] = "failed: not at rest, residual 2.0e-03"
    assert folder.call()[0] == 0


def test_noise_is_told_and_passes(accepted):
    for number, document in enumerate(accepted.bench):
        for record in document["records"]:
            if record["method"] == "tl-enhanced":
                record["ns_best"] *= 1.0 + 0.01 * number
    code, text = accepted.call()
    assert code == 0 and NOISY in text and "cannot be excluded" in text
    name = "box of 576, tl-enhanced, pack double, 1 thread"
    (case,) = accepted.junit().findall(f"./testsuite[@name='speed']/testcase[@name='{name}']")
    assert NOISY in case.find("skipped").get("message")


def test_too_few_processes_cannot_tell(accepted):
    accepted.bench = accepted.bench[: FEWEST - 1]
    code, text = accepted.call(sources=["speed"])
    assert code == 0 and f"fewer than {FEWEST} processes" in text


def test_disturbed_processes_do_not_matter(accepted):
    """One of twelve may be arbitrarily slow: the interval excludes it."""
    for record in accepted.bench[5]["records"][::2]:
        record["ns_best"] *= 1.5
    assert accepted.call()[0] == 0
    assert NOISY not in accepted.call()[1]


def test_other_machines_are_not_gated_in_speed_and_bytes(accepted):
    slow_a_method(accepted)
    move_a_byte(accepted)
    accepted.move_to("Abacus 4")
    code, text = accepted.call()
    assert code == 0 and UNGATED in text.strip().splitlines()[-1]
    (case, *_) = accepted.junit().findall("./testsuite[@name='speed']/testcase")
    assert "does not know this machine" in case.find("skipped").text
    compute_wrong_forces(accepted)
    assert accepted.call()[0] == 1  # a promise holds everywhere


def test_junit_counts_what_it_holds(accepted):
    change_error(accepted)
    accepted.verdicts["records"].append(verdict("twist"))
    accepted.call()
    for suite in accepted.junit():
        cases = suite.findall("testcase")
        assert int(suite.get("tests")) == len(cases) == len({case.get("name") for case in cases})
        for key, tag in (("failures", "failure"), ("skipped", "skipped")):
            assert int(suite.get(key)) == sum(case.find(tag) is not None for case in cases)
        (revision,) = suite.findall("properties/property[@name='revision']")
        assert revision.get("value") == ORIGIN["revision"]
    (accuracy,) = accepted.junit().findall("./testsuite[@name='accuracy']")
    assert (accuracy.get("tests"), accuracy.get("failures"), accuracy.get("skipped")) == (
        "3",
        "1",
        "1",
    )


def test_only_the_sources_asked_for_are_compared(accepted):
    change_error(accepted)
    assert accepted.call(sources=["operations", "speed"])[0] == 0
    assert accepted.call(sources=["accuracy"])[0] == 1


def test_times_are_a_trend_and_never_fail(accepted):
    for document in accepted.bench:
        for record in document["records"]:
            record["ns_best"] *= 2.0
        for peaks in document["peak_gflops"].values():
            peaks["1"] /= 2.0
    code, text = accepted.call()
    assert code == 0 and BETTER not in text
    assert "| box of 576, linear, pack double, 1 thread | 19.96 | 39.92 |" in (
        (accepted.path / "out" / "gate.md").read_text()
    )
    rows = (accepted.path / "out" / "trend.csv").read_text().splitlines()
    assert rows[0] == "date,revision,machine,variant,ns"
    assert len(rows) == 1 + 2 * 27  # of accepting and of comparing
