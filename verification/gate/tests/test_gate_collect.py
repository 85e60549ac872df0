"""The gate's runs of the program: the real one where it is quick, elsewhere a script."""

import json

import h5py
import numpy as np
import pytest
from gate import __main__ as command
from gate import collect

PROGRAM = """#!/usr/bin/env bash
set -e
case $1 in
  methods) echo "tl-full  the displacement hexahedron"; exit ;;
  run) ;;
  *) echo "error: no such thing" >&2; exit {code} ;;
esac
while [ $# -gt 0 ]; do
  case $1 in --threads) threads=$2 ;; -o) output=$2 ;; --precision) precision=$2 ;; esac
  shift
done
{body}
"""


@pytest.fixture
def play(tmp_path, monkeypatch):
    """Replaces the program under test by a script with these commands instead of `run`."""

    def made(body="", code=3):
        for name in ("sandglass", "sandglass-scalar"):
            script = tmp_path / name
            script.write_text(PROGRAM.replace("{body}", body).replace("{code}", str(code)))
            script.chmod(0o755)
        monkeypatch.setenv("SANDGLASS_BINARY", str(tmp_path / "sandglass"))
        return tmp_path

    return made


def answers(folder, *values):
    """Files one.h5, two.h5 ... with these displacements."""
    for name, value in zip(("one", "two"), values):
        with h5py.File(folder / f"{name}.h5", "w") as file:
            file["frames/0001/displacement"] = np.full((3, 3), value)


def told(folder):
    """The entry of bits.json for the double run of column."""
    records = json.loads(collect.bits(folder).read_text())["records"]
    assert len(records) == 2 * len(collect.BIT_CASES)
    return {record["name"]: record["differs"] for record in records}


COPY = 'cp "$(dirname "$0")/$([ $threads = 1 ] && echo one || echo two).h5" "$output"'


def test_the_same_bits(play):
    folder = play(COPY)
    answers(folder, 1.0, 1.0)
    (folder / "two.h5").write_bytes((folder / "one.h5").read_bytes())
    assert set(told(folder).values()) == {""}


def test_one_bit_of_difference(play):
    folder = play(COPY)
    answers(folder, 1.0, np.nextafter(1.0, 2.0))
    assert set(told(folder).values()) == {"/frames/0001/displacement differs"}


def test_zeros_of_either_sign_are_not_the_same_bits(play):
    folder = play(COPY)
    answers(folder, 0.0, -0.0)
    assert set(told(folder).values()) == {"/frames/0001/displacement differs"}


def test_only_one_fails(play):
    folder = play(f"[ $threads = 1 ] || exit 3; {COPY}")
    answers(folder, 1.0, 1.0)
    assert all(text.startswith("exit codes ") for text in told(folder).values())


def test_both_fail_alike(play):
    assert set(told(play("exit 3")).values()) == {""}


def test_program_that_fails_is_exit_code_3(play, capsys):
    folder = play()
    (folder / "baseline.json").write_text(
        '{"format": 1, "history": [], "records": [], "machines": {}}'
    )
    for source in ("accuracy", "operations", "speed"):
        options = ["--baseline", str(folder / "baseline.json"), "-o", str(folder)]
        assert command.main([source, *options]) == 3
        assert "ended with 3: no such thing" in capsys.readouterr().err


def test_operations_of_the_program_itself(tmp_path, capsys):
    """The one quick source: once accepted, it passes; with one more operation, it fails."""
    baseline = tmp_path / "baseline.json"
    options = ["operations", "--baseline", str(baseline), "-o", str(tmp_path)]
    assert command.main([*options, "--accept", "--reason", "a test"]) == 0
    assert command.main(options) == 0
    text = baseline.read_text()
    entry = next(
        line
        for line in text.splitlines()
        if '"tl-perturbation, neo-hookean, kernel, element"' in line
    )
    record = json.loads(entry.strip().rstrip(","))
    fewer = entry.replace(f'"mul": {record["mul"]}', f'"mul": {record["mul"] - 1}')
    baseline.write_text(text.replace(entry, fewer))
    capsys.readouterr()
    assert command.main(options) == 1
    assert "+1; must be equal" in capsys.readouterr().out
