"""`sandglass run --accuracy --against truth`: mesh, output, exit codes and rejected input."""

import re

import h5py
import pytest
from command_line import require_refusal, sandglass


def test_the_mesh_is_refined_until_the_answer_is_near_enough(tmp_path):
    result = tmp_path / "result.h5"
    arguments = ("run", "column", "--accuracy", "0.6%", "--against", "truth", "-o", result)
    outcome = sandglass(*arguments)
    assert outcome.returncode == 0, outcome.stderr
    assert "tl-mean-dilatation, double" in outcome.stdout  # the element that meshes are refined for
    found = re.search(
        r"error against the truth: max (\S+) %.*, on (\d+) elements instead of 270", outcome.stdout
    )
    assert 0.0 < float(found[1]) <= 0.6
    told = re.search(r"^against the truth: max (\S+) %", outcome.stdout, re.MULTILINE)
    assert 0.0 < float(told[1]) <= 0.6
    assert "against the golden" not in outcome.stdout  # it is that of another mesh
    with h5py.File(result) as file:
        assert len(file["mesh/cells"]) == int(found[2]) > 270


def test_a_mesh_that_is_fine_enough_stays():
    outcome = sandglass("run", "column", "--accuracy", "3%", "--against", "truth")
    assert outcome.returncode == 0, outcome.stderr
    assert "on 270 elements instead of 270" in outcome.stdout


def test_a_method_that_errs_more_than_the_mesh_is_told():
    arguments = ("run", "column", "-m", "linear", "--accuracy", "3%", "--against", "truth")
    outcome = sandglass(*arguments)
    assert outcome.returncode == 1, outcome.stderr
    note = "the mesh is fine enough for tl-mean-dilatation, but not for linear"
    assert note in outcome.stdout


@pytest.mark.parametrize(
    "arguments, words",
    [
        (("column", "--against", "truth"), "--against: needs the largest error allowed"),
        (("column", "--against", "golden", "--accuracy", "1%"), "--against: golden not in {truth}"),
        (("column", "--against", "truth", "--accuracy", "0"), "--accuracy = '0' must be a share"),
        (("bar-wave", "--against", "truth", "--accuracy", "1%"), "'bar-wave' is a dynamic case"),
        (
            ("column", "--against", "truth", "--accuracy", "1%", "--sleep", "1%"),
            "leave out --sleep",
        ),
        (
            ("column", "--against", "truth", "--accuracy", "1%", "--checkpoint", "kept"),
            "leave out --checkpoint",
        ),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, tuple) else "",
)
def test_wrong_use_is_told(arguments, words, tmp_path):
    require_refusal(words, tmp_path, "run", *arguments)
