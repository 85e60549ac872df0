"""The commands of the program in Python: all of them, and what they return."""

import inspect
import json
import re

import numpy as np
import pytest
from command_line import BARE, LIMIT, ROOT, documented, dynamic, sandglass as program, write_golden
from module_folder import readme_code

import sandglass as sg

# The counterpart of each command, and of its options that are not parameters of the same name.
COMMANDS = {
    "cases": ("sg.cases", {}),
    "methods": ("sg.methods", {}),
    "run": (
        "sg.Body.solve",
        {
            "--method": "`name`",
            "--output": "`sg.Solution.save`",
            "--estimate": "`sg.estimate`",
            "--describe": "`help(sg.Dynamics)` and so on",
            "--checkpoint": "`sg.Simulation.save_checkpoint` and `resume`",
            "--checkpoint-every": "none, as you choose when a simulation saves",
        },
    ),
    "verify": ("sg.verify", {"--no-costs": "`costs=False`"}),
    "stability": ("sg.stability", {"--map": "`maps`", "--describe": "`sg.axes`"}),
    "choose": ("sg.choose", {"--output": "`body` of the record"}),
    "score": (
        "sg.score",
        {"--limit": "the errors of the record", "--against": "the errors of the record"},
    ),
    "mesh": ("sg.write_mesh", {}),
    "flops": ("sg.flops", {}),
    "kernels": ("sg.kernels", {"--output": "the text returned"}),
    "bench": ("sg.bench", {}),
    "completion": ("none: for shells", {}),
    "manual": ("`help(sandglass)`", {}),
}


def options_of(command):
    text = program(command, "--help", code=0).stdout
    options = re.findall(r"^ +(?:-\w,)?(--[\w-]+)", text, re.MULTILINE)
    return [name for name in options if name not in ("--help", "--json")]


def row_of(command):
    """A row of the README's table. Fails for an option without a counterpart."""
    counterpart, others = COMMANDS[command]
    found = re.match(r"sg\.([\w.]+)", counterpart)
    if not found:
        return f"| `{command}` | {counterpart} | |\n"
    function = sg
    for name in found[1].split("."):
        function = getattr(function, name)
    known = set(inspect.signature(function).parameters)
    if "method" in known:  # the keywords of sg.Method
        known |= set(sg.Method._keys)
    options = options_of(command)
    for option in options:
        assert option in others or option[2:].replace("-", "_") in known, f"{command} {option}"
    assert set(others) <= set(options), command
    rest = "; ".join(f"`{option}`: {where}" for option, where in others.items())
    return f"| `{command}` | `{counterpart}` | {rest}{' ' if rest else ''}|\n"


def test_every_command_and_option_has_a_counterpart_and_the_readme_lists_them():
    overview = program("--help", code=0).stdout
    commands = re.findall(
        r"^  (\w+) {2,}\w", overview[overview.index("Subcommands") :], re.MULTILINE
    )
    assert commands == list(COMMANDS)
    table = "| command | in Python | its other options |\n|---|---|---|\n"
    table += "".join(map(row_of, commands))
    assert table in (ROOT / "python/README.md").read_text(), f"README: the table must be\n{table}"


def plain(value):
    if isinstance(value, sg.Record):
        value = vars(value)
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    return [plain(each) for each in value] if isinstance(value, list) else value


def same(record, document, but=()):
    """Whether a record has the fields and values of a document, up to provenance and times.

    Programs and module are compiled apart, so numbers may differ in their last digits.
    """
    skipped = {"build_flags", "revision", *but}
    if isinstance(document, dict):
        return set(record) == set(document) and all(
            key in skipped or same(record[key], value, but) for key, value in document.items()
        )
    if isinstance(document, list):
        pairs = zip(record, document)
        return len(record) == len(document) and all(same(a, b, but) for a, b in pairs)
    if isinstance(document, float) and isinstance(record, float):
        return record == pytest.approx(document, rel=1e-6, abs=1e-9)
    return record == document


TIMES = {
    "equilibrium_seconds",
    "seconds",
    "check_seconds_per_step",
    "seconds_per_simulated_second",
    "run_seconds_per_simulated_second",
}


def test_lists_are_those_of_the_program():
    for name, listed in (("cases", sg.cases()), ("methods", sg.methods())):
        lines = program(name, code=0).stdout.splitlines()
        assert [line.split()[0] for line in lines] == [each.name for each in listed]
    described = program("stability", "--describe", code=0).stdout
    assert all(f"\n{axis.name} " in described for axis in sg.axes())
    assert sg.flops().records[0].total > 0


def test_counts_and_kernels_are_those_of_the_program(block):
    assert same(plain(sg.flops()), documented("flops")[1])
    text = program("kernels", "tl-perturbation", block, "--dialect", "cuda", code=0).stdout
    lines = sg.kernels("tl-perturbation", block, dialect="cuda").splitlines()
    assert [a for a, b in zip(lines, text.splitlines()) if a != b and "written by" not in a] == []
    assert len(lines) == len(text.splitlines()) > 100


def test_verify_and_score_are_those_of_the_program(block):
    block.write_text(block.read_text() + LIMIT.format(method="tl-full", below=0.5))
    write_golden(block)
    _, document = documented("verify", block, "--no-costs")
    found = sg.verify(block, costs=False)
    assert same(plain(found), document, TIMES)
    assert [limit.holds for limit in found.limits] == [True]
    by_body = sg.verify(sg.Body.read(block), costs=False, threads=1)
    assert same(plain(by_body), document, TIMES)
    answer = sg.Body.read(block).solve(name="tl-full")
    answer.save(block.parent / "answer.h5")
    _, document = documented("score", block.parent / "answer.h5", "--case", block)
    for given in (block.parent / "answer.h5", answer, answer.displacement):
        name = None if given is not answer and hasattr(given, "stem") else "answer"
        scored = sg.score(given, block, name=name)
        assert same(plain(scored), document["records"][0], {"method"})
        assert 0 < scored.golden.max_relative_error < 0.5
    exact = sg.Body.read(block).solve(name="tl-mean-dilatation")
    assert sg.score(exact, block).golden.max_relative_error < 1e-9  # compiled apart


def test_a_choice_is_a_body_that_solves(block):
    """The rungs are those of the program; which is the cheapest is measured, and may differ."""
    methods = ["tl-perturbation", "tl-mean-dilatation"]
    _, document = documented("choose", block, "--tolerance", "5%", "--all", "-m", *methods)
    shares = []
    given = {"tolerance": 0.05, "methods": methods, "all": True, "progress": shares.append}
    found = sg.choose(block, **given)
    names = [sorted(rung["rung"] for rung in each["rungs"]) for each in (document, plain(found))]
    assert names[0] == names[1] and shares and max(shares) <= 1
    chosen = found.rungs[found.chosen]
    assert chosen.outcome == "chosen" and chosen.error < 0.05
    again = found.body.solve()
    (method,) = [table for table in found.body.tables if isinstance(table, sg.Method)]
    assert method.name == chosen.method and np.isfinite(again.displacement).all()
    assert sg.choose(block, tolerance=1e-9, methods=["tl-full"]).body is None


def test_the_readme_chooses_and_solves():
    found = {}
    exec(readme_code("Commands"), found)
    head = found["solution"].sets["head"]
    assert np.allclose(found["solution"].displacement[head, 0], 0.01, rtol=1e-6)  # perhaps in float


def test_a_body_of_arrays_may_be_chosen_for(block):
    """Its mesh is in memory, and so is that of the choice, after all files are gone."""
    body = sg.Body.read(block)
    mesh = sg.Mesh(body.mesh.points, body.mesh.cells)
    body = sg.Body(mesh, body.material, body.tables, sets=body.sets)
    chosen = sg.choose(body, tolerance="10%", methods=["tl-mean-dilatation"]).body
    assert np.array_equal(chosen.mesh.points, mesh.points)
    assert chosen.solve().displacement.shape == mesh.points.shape


def test_maps_of_failure_are_those_of_the_program(block, tmp_path):
    call = ["--map", "kappa", "--values", "kappa=0,0.01", "--methods", "tl-perturbation"]
    _, document = documented("stability", block, *call, "--folder", tmp_path / "cells")
    given = {"maps": ["kappa"], "values": ["kappa=0,0.01"], "methods": ["tl-perturbation"]}
    assert same(plain(sg.stability(block, **given)), document)
    assert len(list((tmp_path / "cells").rglob("*.json"))) == 2
    (tmp_path / "own").mkdir()
    sg.stability(block, **given, folder=tmp_path / "own")
    assert len(list((tmp_path / "own").rglob("*.json"))) == 2


def test_meshes_are_written_for_others(block, tmp_path):
    found = sg.write_mesh(block, tmp_path / "own.inp")
    text = program("mesh", block, "-o", tmp_path / "program.inp", code=0).stdout
    assert (tmp_path / "own.inp").read_text() == (tmp_path / "program.inp").read_text()
    assert f"{found.nodes} nodes, {found.elements} elements" in text
    assert sum(found.counts) == found.elements and found.smallest_scaled_jacobian == 1


def test_times_are_measured(block):
    """Values of times are those of the machine; the fields and what is timed are checked."""
    few = {"methods": ["tl-perturbation"], "precision": ["double"], "repetitions": 2}
    _, document = documented("bench", "-e", "40", "-m", "tl-perturbation", "-r", "2", "-t", "1")
    found = sg.bench(elements=[40], threads=[1], **few)
    assert set(plain(found.records[0])) == set(document["records"][0])
    assert [(r.status, r.ns_per_element_step > 0) for r in found.records] == [("ok", True)]
    (rest,) = sg.bench(block, rest=True, **few).records
    assert rest.seconds_to_rest > 0
    (side,) = sg.bench(block, bodies=3, **few).records
    assert side.status == "ok" and side.bodies == 3
    with pytest.raises(sg.InputError, match="exclude each other"):
        sg.bench(rest=True, bodies=2)


def test_a_run_may_refine_its_mesh_or_let_elements_sleep(block):
    """Refined: more nodes, the original ones first, and an answer within the accuracy of the truth,
    with an allowance for its estimate. Asleep: within the share of the whole body's answer."""
    body = sg.Body.read(block)
    refined, whole = body.solve(against="truth", accuracy="3%"), body.solve()
    assert len(refined.points) > len(whole.points) and refined.summary["error"] <= 0.03
    assert np.array_equal(refined.points[: len(whole.points)], whole.points)
    with pytest.raises(sg.InputError, match="needs accuracy, the largest allowed error"):
        body.solve(against="truth")
    asleep = body.solve(sleep="1%")
    far = np.linalg.norm(asleep.displacement - whole.displacement, axis=1).max()
    assert far < 0.01 * np.linalg.norm(whole.displacement, axis=1).max()
    with pytest.raises(sg.InputError, match="derivatives: elements sleep"):
        asleep.gradient()
    truth, golden = sg.estimate(whole, against="truth"), sg.estimate(body)
    assert golden == whole.estimate() and truth[0] > golden[0] > golden[1] > 0
    with pytest.raises(sg.InputError, match="sleep: elements sleep in quasi-static cases"):
        sg.Body.of_toml(dynamic(BARE, duration=0.1)).solve(sleep=0.1)


def test_interrupting_a_command_ends_it(block):
    def stop(share):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sg.verify(block, progress=stop)


def test_progress_is_a_line_that_is_cleared(block, capsys):
    sg.verify(block, threads=1, progress=True)
    *_, last, end = capsys.readouterr().err.split("\r")
    assert end == "" and last.strip() == ""


def test_a_record_shows_its_fields(block):
    record = sg.score(sg.Body.read(block).solve(), block)
    assert "max_relative_error=" in repr(record) and repr(record).startswith("Record(\n")
    assert json.loads(json.dumps(plain(record))) == plain(record)
    assert "[" in repr(sg.flops()) and "records of method" in repr(sg.flops())


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: sg.choose(1), "case must be an sg.Body, a path"),
        (lambda: sg.choose("nowhere"), "is neither a file nor a known case"),
        (lambda: sg.choose("column", tolerance="1,5%"), "tolerance = '1,5%' must be a share"),
        (lambda: sg.choose("column", tolerance=[1]), "tolerance must be a number or a text"),
        (lambda: sg.choose("column", budget="1h"), "budget = '1h' must be a positive time"),
        (lambda: sg.choose("column", methods="tl-full"), "methods must be a list of texts"),
        (lambda: sg.choose("column", threads=0), r"threads = 0 must be in \[1, 1024\]"),
        (lambda: sg.choose("column", all=1), "all must be True or False"),
        (lambda: sg.verify("column", threads=-1), r"threads = -1 must be in \[0, 1024\]"),
        (lambda: sg.verify("column", precision="half"), "precision = 'half'"),
        (lambda: sg.score(np.zeros((3, 3)), "column"), "displacement must have the shape"),
        (lambda: sg.score("x", "column", tolerance=2), r"tolerance = 2 must be in \(0, 1\)"),
        (lambda: sg.kernels("tl-ful", "column"), "did you mean 'tl-full'"),
        (lambda: sg.kernels("tl-full", "column", material=2**40), "material must be in"),
        (lambda: sg.write_mesh("column", "a.x"), "format 'x'; allowed are"),
        (lambda: sg.stability("column", maps=["kapa"]), "did you mean 'kappa'"),
        (lambda: sg.bench(elements=[0]), "elements = 0 must be in"),
        (lambda: sg.estimate(None), "answer must be an sg.Solution"),
    ],
)
def test_wrong_arguments_are_named(call, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises((TypeError, sg.InputError), match=words):
        call()
    assert not list(tmp_path.iterdir())
