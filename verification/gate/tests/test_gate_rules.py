"""Intervals and rules at, below and above their limits; ratios within one process."""

import pytest
from gate.bench import read_bench
from gate.compare import (
    BETTER,
    FLOOR,
    NOISY,
    RELATIVE,
    SAME,
    SPEED_LIMIT,
    WORSE,
    judge_error,
    judge_ratio,
)
from gate.interval import CONFIDENCE, FEWEST, Interval


def test_interval_leaves_out_as_many_as_confidence_allows():
    """Of 12: 1 - 2 (1 + 12) / 2^12 = 0.9937 without one at each end, 0.96 without two."""
    samples = [3.0, 1.0, 2.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 100.0]
    assert CONFIDENCE == 0.99
    assert Interval.of(samples) == Interval(2.0, 6.5, 11.0)
    assert Interval.of(samples[:FEWEST]) == Interval(1.0, 4.5, 8.0)
    assert Interval.of(samples[: FEWEST - 1]) == Interval(0.0, 4.0, float("inf"))
    assert Interval.of([2.0]) == Interval(0.0, 2.0, float("inf"))


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("error", [0.0, 1e-6, 0.01, 1.0])
def test_error_may_move_by_share_and_floor(error, precision):
    margin = RELATIVE * error + FLOOR[precision]
    assert judge_error(error, error + 0.99 * margin, precision)[0] == SAME
    assert judge_error(error, error + 1.01 * margin, precision)[0] == WORSE
    assert judge_error(error, error - 0.99 * margin, precision)[0] == SAME
    assert judge_error(error, error - 1.01 * margin, precision)[0] == BETTER


def test_ratio_is_judged_by_its_whole_interval():
    old, line = Interval(1.8, 1.9, 2.0), 2.0 * (1.0 + SPEED_LIMIT)
    floor = 1.8 / (1.0 + SPEED_LIMIT)
    assert judge_ratio(old, Interval(1.99, 2.0, 0.999 * line))[0] == SAME
    assert judge_ratio(old, Interval(0.999 * line, 1.01 * line, 1.02 * line))[0] == NOISY
    assert judge_ratio(old, Interval(1.0, 1.9, 1.001 * line))[0] == NOISY
    assert judge_ratio(old, Interval(1.001 * line, 1.01 * line, 1.02 * line))[0] == WORSE
    assert judge_ratio(old, Interval(1.0, 1.5, 0.999 * floor))[0] == BETTER
    assert judge_ratio(old, Interval(1.0, 1.7, 1.001 * floor))[0] == SAME
    assert judge_ratio(old, Interval(0.0, 3.0, float("inf")))[0] == NOISY


def test_ratios_are_of_one_process(folder):
    """Processes at twice the speed of each other have the same ratios."""
    for number, document in enumerate(folder.bench):
        for record in document["records"]:
            record["ns_best"] = (
                10.0 * (1 + number % 2) * (2.0 if record["method"] == "linear" else 1.0)
            )
    files = [folder.write(f"p{n}.json", document) for n, document in enumerate(folder.bench)]
    records, _, _ = read_bench(files)
    ratios = {r.name: r.figures["over pace"] for r in records if "over pace" in r.figures}
    # The pace of the others: 10 for linear; one of seven twice that for other pacemakers.
    assert ratios["box of 576, linear, pack double, 1 thread"].spread < 1e-15
    assert ratios["box of 576, linear, pack double, 1 thread"].median == pytest.approx(2.0)
    assert ratios["box of 576, tl-none, pack double, 1 thread"].median == pytest.approx(
        2 ** (-1 / 7)
    )
    assert ratios["box of 576, ul-enhanced, pack double, 1 thread"].median == pytest.approx(
        2 ** (-1 / 8)
    )
