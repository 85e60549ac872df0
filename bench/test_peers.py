"""The comparison with CalculiX: both solve the same problem; failures; files; exit codes."""

import json
import shutil
import sys

import pytest

import peers
from peer_report import spread
from rivals.calculix import PROGRAM, CalculiX
from rivals.program import Run
from test_measuring import measured
from command_line import BLOCK

CCX = ["--program", f"calculix={PROGRAM}"]
SMALL = [*CCX, "--repetitions", "1", "--steps", "60", "--methods", "tl-perturbation", "tl-full"]
needs_ccx = pytest.mark.skipif(
    shutil.which(PROGRAM) is None, reason="ccx is not installed (package calculix-ccx)"
)


def _compare(case, *options):
    """Exit code and stored document (None without one) of the comparison."""
    return measured(peers.main, case.parent, str(case), *SMALL, *options)


@needs_ccx
def test_the_same_element_gives_the_same_answers(block, capsys):
    answers = block.parent / "answers"
    words = ["--elements", "C3D8", "C3D8R", "--answers", str(answers)]
    code, document = _compare(block, *words)
    assert code == 0
    rest = {record["element"]: record for record in document["static"]}
    assert set(rest) == {"C3D8", "C3D8R", "tl-perturbation", "tl-full"}
    # Six digits are written, and both stop at residuals of 1e-8 of the reactions.
    assert abs(rest["C3D8"]["twin"] - rest["tl-full"]["twin"]) < 1e-5
    assert rest["C3D8"]["twin"] > 0.1 > 10 * rest["C3D8R"]["twin"]  # one of the two elements locks
    motion = {record["element"]: record for record in document["in_motion"]}
    assert motion["C3D8"]["nearest"]["method"] == "tl-full"
    # Both are of second order: they may differ by half a squared step, of 60, times the largest
    # acceleration of the loading curve, 5.77 of the imposed displacement over the squared ramp.
    assert motion["C3D8"]["nearest"]["difference"] < 5.77 / 2 / 60**2
    assert motion["C3D8"]["to_mean_dilatation"] > 0.05
    for record in document["in_motion"]:
        assert record["steps"] == 60 and record["ns_of_rounds"] == [record["ns_per_element_step"]]
        assert record["golden"] is record["truth"] is None  # motions have none
    for record in (*document["static"], *document["in_motion"]):
        (seconds,) = record["seconds_of_runs"]
        assert 0 < record["processor_seconds"] < seconds + 0.02  # one thread; clocks tick at 10 ms
        assert record["seconds"] == seconds
        assert record["processor_seconds_of_runs"] == [record["processor_seconds"]]
    (program,) = document["programs"]
    assert program["version"] and document["sandglass"]
    for record in document["static"]:
        assert (answers / record["answer"]).is_file()
    said = capsys.readouterr().out
    assert "## Static equilibrium" in said and "## In motion" in said and "| CalculiX " in said


def test_fenicsx_finds_the_golden_in_one_step_or_in_many(block):
    """Its own element is tl-mean-dilatation; a search for rest ends at a residual of 1e-8."""
    pytest.importorskip("dolfinx", reason="FEniCSx is not installed (package python3-dolfinx)")
    words = ["--program", f"fenicsx={sys.executable}", "--repetitions", "1"]
    words += ["--methods", "tl-perturbation", "--json", str(block.parent / "peers.json")]
    assert peers.main([str(block), *words, "--steps", "60"]) == 0
    document = json.loads((block.parent / "peers.json").read_text())
    many, one, ours = document["static"][:3]
    assert (many["load_steps"], one["load_steps"]) == (10, 1)
    assert many["iterations"] > one["iterations"] > 2
    assert max(many["twin"], one["twin"]) < 1e-6 < 1e-3 < ours["twin"]
    assert {record["program"] for record in document["in_motion"]} == {"Sandglass"}
    (program,) = document["programs"]
    assert program["version"] and 0 < one["seconds"] < one["processor_seconds"]


@needs_ccx
def test_an_element_that_fails_is_reported_and_the_others_kept(block, monkeypatch, capsys):
    there = CalculiX.run

    def fail(program, deck, motion):
        if "TYPE=C3D8I" in deck.read_text():
            raise peers.ComputationError("no equilibrium")
        return there(program, deck, motion)

    monkeypatch.setattr(CalculiX, "run", fail)
    code, document = _compare(block, "--solves", "rest", "--elements", "C3D8I", "C3D8R")
    assert code == 3
    found = {record["element"]: record["failure"] for record in document["static"]}
    assert found["C3D8I"] == "no equilibrium" and found["C3D8R"] is found["tl-full"] is None
    assert "error: CalculiX C3D8I, Newton: no equilibrium" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words, message",
    [
        (["--program", "ccx=ccx"], "--program ccx: known: calculix, febio"),
        (["--program", "niftysim"], "must be NAME[:BUILD]=PATH"),
        (["--program", "niftysim=none/there"], "none/there: no such file"),
        (["--about", "febio=4.11"], "--about febio: there is no --program febio"),
        (["--elements", "C3D9"], "did you mean 'C3D8'"),
    ],
)
def test_wrong_programs(block, capsys, words, message):
    assert peers.main([str(block), "--program", f"calculix={sys.executable}", *words]) == 2
    assert message in capsys.readouterr().err


@needs_ccx
def test_a_law_that_calculix_cannot_do(block, capsys):
    block.write_text(BLOCK.replace('"neo-hookean"', '"st-venant-kirchhoff"'))
    assert _compare(block) == (2, None)
    assert "is not known to CalculiX" in capsys.readouterr().err


@needs_ccx
def test_loads_in_motion_are_refused(block, capsys):
    block.write_text(BLOCK + '\n[[force]]\nset = "head"\ntotal = [0.0, 0.0, 1.0]\n')
    assert _compare(block)[0] == 2
    assert "explicit runs support only [[displacement]]" in capsys.readouterr().err


@pytest.mark.parametrize(
    "old, new, message",
    [
        ('"quasi-static"', '"dynamic"', "case.answer = 'dynamic' must be 'quasi-static'"),
        ('"neo-hookean"', '"glass"', "'glass' is not known"),
        ('set = "head"', 'set = "hat"', "hat"),
    ],
)
def test_bad_cases(block, capsys, old, new, message):
    block.write_text(BLOCK.replace(old, new))
    assert peers.main([str(block)]) == 2
    assert message in capsys.readouterr().err


def test_a_case_that_is_not_there(capsys):
    assert peers.main(["colum"]) == 2
    assert "'colum' is neither a file nor a known case; did you mean 'column'" in (
        capsys.readouterr().err
    )


def test_a_step_costs_what_the_longer_run_takes_more():
    """Time before the first step does not count; rounds are kept separate."""
    short = iter(
        [Run(9.0, 1.0, 10, 0, None), Run(5.0, 2.0, 10, 0, None), Run(7.0, 3.0, 10, 0, None)]
    )
    longer = iter(
        [Run(1.0, 3.0, 30, 0, None), Run(1.0, 5.0, 30, 0, None), Run(1.0, 10, 30, 0, None)]
    )
    row = peers.Row("P", "E", peers.EXPLICIT, {"answer": short.__next__, "longer": longer.__next__})
    for _ in range(3):
        row.round()
    assert row.per_step() == [2 / 20, 3 / 20, 7 / 20]
    record = row.record()
    assert record["seconds_of_runs"] == [9.0, 5.0, 7.0] and record["seconds"] == 7.0
    assert record["processor_seconds"] == 2.0 and record["seconds_per_step"] == 0.2
    assert spread(record["seconds_of_runs"]) == "7 (5 to 9)"
