"""The command line: what it stores, what it skips, exit codes. Uses the solver's binary."""

import importlib.util
import json
import shlex

import numpy as np
import pytest

import time_to_rest
from command_line import BLOCK
from common.program import CASES, binary

RECORD = {
    "case": "block",
    "method": "tl-perturbation",
    "precision": "double",
    "evaluations": 100,
    "seconds_to_1_percent": 0.5,
    "seconds_to_0_1_percent": 0.75,
    "seconds_to_rest": 1.0,
    "residual": 1e-8,
}


def _measure(case, *options):
    """Exit code and stored document (None without one) of the command line."""
    output = case.parent / "out.json"
    code = time_to_rest.main([str(case), "--json", str(output), *options])
    return code, json.loads(output.read_text()) if output.exists() else None


def _stand_in(tmp_path, monkeypatch, script):
    """A shell script in front of the solver, which passes on what it does not answer itself."""
    program = tmp_path / "sandglass"
    real = shlex.quote(str(binary()))
    program.write_text(f'#!/bin/sh\n{script}\nexec {real} "$@"\n')
    program.chmod(0o755)
    monkeypatch.setenv("SANDGLASS_BINARY", str(program))


def test_records_of_bench_itself(block):
    """The solver's own records, with their figures in the required order."""
    code, document = _measure(block, "--programs", "sandglass")
    assert code == 0
    found = {(timed["method"], timed["precision"]) for timed in document["records"]}
    assert found == {(m, p) for m in time_to_rest.METHODS for p in ("double", "float")}
    for timed in document["records"]:
        names = ("1_percent", "0_1_percent", "rest")
        seconds = [timed[f"seconds_to_{name}"] for name in names]
        assert 0 < seconds[0] <= seconds[1] <= seconds[2]


def test_what_came_to_rest_is_kept_where_bench_fails(block, monkeypatch, capsys):
    listed = shlex.quote(json.dumps({"records": [RECORD]}))
    script = f"""if [ "$1 $2 $4" = "bench --rest --json" ]; then
  echo {listed} > "$5"; echo "error: burst" >&2; exit 3
fi"""
    _stand_in(block.parent, monkeypatch, script)
    code, document = _measure(block, "--programs", "sandglass")
    assert code == 3
    (found,) = document["records"]
    assert {key: found[key] for key in RECORD} == RECORD
    assert document["processor"] and document["versions"]["sandglass"]
    told = capsys.readouterr()
    assert "burst" in told.err and "no golden" in told.err and "tl-perturbation" in told.out


def test_missing_programs_are_named_and_left_out(block, monkeypatch, capsys):
    there = importlib.util.find_spec
    monkeypatch.setattr(time_to_rest.shutil, "which", lambda name: None)
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == "dolfinx" else there(name)
    )
    code, document = _measure(block)
    assert code == 0
    assert {timed["program"] for timed in document["records"]} == {"sandglass"}
    told = capsys.readouterr().err
    assert "package python3-dolfinx" in told and "package calculix-ccx" in told


@pytest.mark.parametrize(
    "old, new, told",
    [
        ('"quasi-static"', '"dynamic"', "case.answer = 'dynamic' must be 'quasi-static'"),
        ('"neo-hookean"', '"glass"', "'glass' is not known"),
        ('set = "head"', 'set = "hat"', "hat"),
    ],
)
def test_bad_case(block, capsys, old, new, told):
    block.write_text(BLOCK.replace(old, new))
    assert _measure(block) == (2, None)
    assert told in capsys.readouterr().err


def test_bad_usage(block, capsys):
    assert time_to_rest.main(["no-such-case"]) == 2
    assert "'no-such-case'" in capsys.readouterr().err
    assert time_to_rest.main([str(block), "--json", str(block.parent / "no" / "out.json")]) == 2
    assert "does not exist" in capsys.readouterr().err


def test_canonical_case_by_name():
    assert time_to_rest.case_path("column") == CASES / "column.toml"


def test_golden_is_that_of_the_reference(block):
    pytest.importorskip("dolfinx", reason="FEniCSx is not installed (package python3-dolfinx)")
    import golden_timing
    import solve
    from case_file import read_case
    from mesh_file import load_case_mesh, make_mesh

    make_mesh(block, block.parent / "mesh.h5")
    command = [str(block), "--mesh", str(block.parent / "mesh.h5")]
    output = block.parent / "golden.npz"
    assert golden_timing.main([*command, "-o", str(output), "--load-steps", "2"]) == 0
    case = read_case(block)
    mesh, _ = load_case_mesh(case, block.parent / "mesh.h5")
    (expected,), outcome, _ = solve.solve_case(case, mesh, 0, 2)
    with np.load(output) as found:
        # Both stop at a correction below 1e-10, quadratically: at round-off.
        assert np.abs(found["displacement"] - expected).max() < 1e-14
        assert found["iterations"] == outcome.newton_iterations
        seconds = [found[f"seconds_to_{name}"] for name in ("1_percent", "0_1_percent", "rest")]
    assert 0 < seconds[0] <= seconds[1] <= seconds[2]


def test_golden_by_other_load_steps_is_the_golden(block):
    pytest.importorskip("dolfinx", reason="FEniCSx is not installed (package python3-dolfinx)")
    code, document = _measure(block, "--programs", "golden", "--load-steps", "3", "1")
    assert code == 0
    for steps, timed in zip((3, 1), document["records"], strict=True):
        assert (timed["program"], timed["load_steps"]) == ("FEniCSx", steps)
        assert timed["method"] == f"Q1-P0, load steps: {steps}"
        # Both are at round-off, some 1e-15 of the imposed displacement.
        assert timed["error_to_golden_max"] < 1e-13
        assert 0 < timed["seconds_to_1_percent"] <= timed["seconds_to_rest"]
        assert timed["jit_seconds"] > 0  # in an empty cache, both times


def test_seconds_until_it_stays_near_the_end():
    pytest.importorskip("dolfinx", reason="FEniCSx is not installed (package python3-dolfinx)")
    import golden_timing

    # Close to the end once at 11 s, away again, close for good from 13 s on; exact at 14 s.
    heights = [(10.0, 0.0), (11.0, 0.999), (12.0, 0.5), (13.0, 1.004), (14.0, 1.0)]
    moments = [(at, np.array([[0.0, 0.0, z]])) for at, z in heights]
    assert golden_timing.seconds_within(moments, 0.01, 1.0) == 3.0
    assert golden_timing.seconds_within(moments, 0.001, 1.0) == 4.0
    assert golden_timing.seconds_within(moments, 0.001, 10.0) == 3.0
    assert golden_timing.seconds_within(moments, 2.0, 1.0) == 0.0
