"""`sandglass run --accuracy --against truth`: mesh, output, exit codes and rejected input."""

import re

import h5py
from command_line import sandglass


def test_the_mesh_is_refined_until_the_answer_is_near_enough(tmp_path):
    result = tmp_path / "result.h5"
    arguments = ("run", "column", "--accuracy", "0.6%", "--against", "truth", "-o", result)
    outcome = sandglass(*arguments, code=0)
    assert "tl-mean-dilatation, double" in outcome.stdout  # refined for this one
    found = re.search(
        r"error against the truth: max (\S+) %.*, on (\d+) elements instead of 270", outcome.stdout
    )
    assert 0.0 < float(found[1]) <= 0.6
    figure = re.search(r"^against the truth: max (\S+) %", outcome.stdout, re.MULTILINE)
    assert 0.0 < float(figure[1]) <= 0.6
    assert "against the golden" not in outcome.stdout  # the golden is for another mesh
    with h5py.File(result) as file:
        assert len(file["mesh/cells"]) == int(found[2]) > 270


def test_a_mesh_that_is_fine_enough_stays():
    outcome = sandglass("run", "column", "--accuracy", "3%", "--against", "truth", code=0)
    assert "on 270 elements instead of 270" in outcome.stdout


def test_a_method_that_errs_more_than_the_mesh_is_reported():
    arguments = ("run", "column", "-m", "linear", "--accuracy", "3%", "--against", "truth")
    outcome = sandglass(*arguments, code=1)
    note = "the mesh is fine enough for tl-mean-dilatation, but not for linear"
    assert note in outcome.stdout
