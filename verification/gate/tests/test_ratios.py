"""Ratios of two programs, here scripts with known times."""

import pytest
from gate import ratios

# Times of a process scatter by up to 1 %; one in ten is disturbed.
PROGRAM = """#!/usr/bin/python3
import json, pathlib, sys
count = pathlib.Path(__file__).with_suffix(".count")
number = int(count.read_text()) + 1 if count.exists() else 0
count.write_text(str(number))
scatter = 1.0 + 0.001 * (7 * number % 11) + 5.0 * (number % 10 == 5)
records = [{"method": name, "precision": "double", "ns_best": ns * scatter}
           for name, ns in TIMES.items()] + [{"method": "b", "precision": "float", "ns_best": None}]
open(sys.argv[sys.argv.index("--json") + 1], "w").write(json.dumps({"records": records}))
"""


@pytest.fixture
def compare(tmp_path, capsys):
    """(exit code, rows) of two programs with given times."""

    def called(before, after, *words):
        for name, times in (("before", before), ("after", after)):
            script = tmp_path / f"{name}.py"
            script.write_text(PROGRAM.replace("TIMES", repr(times)))
            script.chmod(0o755)
        code = ratios.main([str(tmp_path / "before.py"), str(tmp_path / "after.py"), *words])
        return code, capsys.readouterr().out.splitlines()

    return called


def test_a_slower_method_is_named(compare):
    code, rows = compare({"a": 10.0, "c": 4.0}, {"a": 10.4, "c": 4.0})
    assert code == 1 and rows[0].split()[:3] == ["a", "double", "1.040"]
    assert rows[0].endswith("SLOWER") and not rows[1].endswith(("SLOWER", "faster"))
    assert rows[2] == "2 ratios of after over before; 1 are more than 1 % slower"


def test_faster_and_allowed(compare):
    code, rows = compare({"a": 10.0, "c": 4.0}, {"a": 9.0, "c": 4.1}, "--most", "5")
    assert code == 0 and rows[0].endswith("faster") and not rows[1].endswith("SLOWER")


@pytest.mark.parametrize("words", [["--processes", "7"], ["--most"]])
def test_wrong_use(compare, words):
    assert compare({"a": 1.0}, {"a": 1.0}, *words)[0] == 2


def test_programs_without_a_method_in_common(compare):
    assert compare({"a": 1.0}, {"c": 1.0})[0] == 3


def test_interval_leaves_out_as_many_as_confidence_allows():
    """Of 12: 1 - 2 (1 + 12) / 2^12 = 0.9937 without one at each end, 0.96 without two."""
    samples = [3.0, 1.0, 2.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 100.0]
    assert ratios.interval(samples) == (2.0, 6.5, 11.0)
    assert ratios.interval(samples[:8]) == (1.0, 4.5, 8.0)
