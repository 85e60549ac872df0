"""`sandglass score --limit`: the error that is limited, exit codes, output."""

import pytest
from command_line import BARE, documented, sandglass, write_golden


@pytest.fixture
def answer(block):
    """A case with a golden, and the answer of the paper's element."""
    write_golden(block)
    result = block.parent / "answer.h5"
    assert sandglass("run", block, "-o", result).returncode == 0
    return result


def scored(answer, *arguments):
    """The outcome, and the errors as fractions."""
    case = answer.parent / "block.toml"
    outcome, document = documented("score", answer, "--case", case, *arguments)
    return outcome, document["records"][0]


def test_limits_just_above_and_below_the_errors(answer):
    """Each figure has its own limit: max and rms differ, so swapping them would fail."""
    outcome, record = scored(answer)
    assert outcome.returncode == 0 and "limit" not in outcome.stdout
    largest, mean = (record["golden"][f"{name}_relative_error"] for name in ("max", "rms"))
    assert 1e-4 < mean < 0.9 * largest < 0.5
    above, below = 1.01, 0.99
    for limits, broken in [
        ((f"max={above * largest}", f"rms={above * mean}"), []),
        ((f"max={100 * above * largest}%", f"rms={100 * above * mean}%"), []),
        ((f"max={below * largest}", f"rms={above * mean}"), ["max"]),
        ((f"max={above * largest}", f"rms={100 * below * mean}%"), ["rms"]),
        ((f"rms={below * mean}", f"max={below * largest}"), ["rms", "max"]),
    ]:
        words = [word for limit in limits for word in ("--limit", limit)]
        outcome, record = scored(answer, *words)
        assert outcome.returncode == (1 if broken else 0), outcome.stderr
        printed = [line.split()[1:3] for line in outcome.stdout.splitlines() if line[:5] == "limit"]
        assert [figure for verdict, figure in printed if verdict == "BROKEN:"] == broken
        assert len(printed) == len(limits) and record["golden"]["max_relative_error"] == largest


def test_a_limit_holds_against_the_truth_where_asked():
    """The column's golden has no distance from itself, and about a percent from the truth."""
    score = ("score", "reference/golden/column.h5", "--case", "column", "--limit", "max=0.1%")
    assert sandglass(*score).returncode == 0
    outcome = sandglass(*score, "--against", "truth", code=1)
    assert "BROKEN: max error against the truth" in outcome.stdout
    profile = (*score[:4], "--limit", "profile=0.5%", "--against", "truth")
    assert sandglass(*profile).returncode == 1


def test_without_a_golden_the_mean_dilatation_element_judges(block):
    block.write_text(BARE)
    accurate, other = block.parent / "accurate.h5", block.parent / "other.h5"
    for result, method in [(accurate, "tl-mean-dilatation"), (other, "tl-none")]:
        assert sandglass("run", block, "-m", method, "-o", result).returncode == 0
    for result, code in [(accurate, 0), (other, 1)]:
        outcome = sandglass("score", result, "--case", block, "--limit", "max=0.001%", code=code)
        assert "max error against the mean-dilatation element" in outcome.stdout
        first, heads, figures = outcome.stdout.splitlines()[:3]
        assert first.startswith(f"block: {result.stem}, errors")
        assert figures.startswith("against the mean-dilatation element ")
        assert len(heads) == len(figures)  # columns are right-aligned with their heads
    own = block.parent / "block.h5"
    own.write_bytes(accurate.read_bytes())
    assert sandglass("score", own, "--case", block).stdout.startswith("block: errors in %")


@pytest.mark.parametrize(
    "arguments, words",
    [
        (("--limit", "max"), "--limit 'max' needs a value, such as max=2% or max=0.02"),
        (("--limit", "mx=2%"), "'mx' is not a figure; did you mean 'max'? known: max, profile"),
        (("--limit", "max=2pc"), "--limit max = '2pc' must be a share in (0, 1]"),
        (("--limit", "max=2,5%"), "did you mean 2.5%, with a decimal point?"),
        (("--limit", "max=0"), "--limit max = '0' must be a share in (0, 1]"),
        (("--limit", "profile=2%"), "--limit profile: block has no [profile]"),
        (("--limit", "max=2%", "--against", "truth"), "block has no stored truth"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, tuple) else "",
)
def test_wrong_limits_are_reported(answer, tmp_path_factory, arguments, words):
    command = ("score", answer, "--case", answer.parent / "block.toml", *arguments)
    empty = tmp_path_factory.mktemp("empty")
    sandglass(*command, "--json", "s.json", cwd=empty, code=2, message=words)
    assert not list(empty.iterdir())
