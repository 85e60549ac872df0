"""`sandglass choose`: its choice and reasons, agreement of predictions and runs, rejected input."""

import re

import h5py
import numpy as np
import pytest
from command_line import BLOCK, ROOT, documented, interrupted, sandglass, write_golden
from scipy.interpolate import RegularGridInterpolator

from common.result_file import last_displacement

CASES = ROOT / "cases"


def choose(*arguments, code=0):
    """The outcome of the command, and its JSON document. code: its exit code."""
    return documented("choose", *arguments, code=code)


def copied(name, folder, *replaced):
    """A case of the repository in its own folder, with texts replaced."""
    text = (CASES / f"{name}.toml").read_text()
    for old, new in replaced:
        assert old in text
        text = text.replace(old, new)
    for kind in ("golden", "truth"):
        stored = ROOT / "reference" / kind / f"{name}.h5"
        text = text.replace("[comparison]", f'[comparison]\n{kind} = "{stored}"')
    case = folder / f"{name}.toml"
    case.write_text(text)
    return case


def answer(case, *arguments):
    """Nodes and final displacements of a run, m."""
    result = case.parent / "result.h5"
    sandglass("run", case, *arguments, "-o", result, code=0)
    with h5py.File(result) as file:
        return file["mesh/points"][:], last_displacement(result)


def on_lattice(points, u, wanted):
    """A field on a lattice of boxes at other points, by scipy's trilinear interpolation."""
    axes = [np.unique(points[:, i].round(12)) for i in range(3)]
    places = tuple(np.searchsorted(axes[i], points[:, i].round(12)) for i in range(3))
    grid = np.zeros([len(axis) for axis in axes] + [3])
    grid[places] = u
    return RegularGridInterpolator(axes, grid, bounds_error=False, fill_value=None)(wanted)


def largest(difference, unit):
    return np.linalg.norm(difference, axis=1).max() / unit


def chosen_of(document):
    return document["rungs"][document["chosen"]]


def test_light_touch_takes_the_condensed_linear_answer(tmp_path):
    """1 mm on an organ of 16 cm at 5 %; the chosen case gives exactly the predicted error."""
    case = copied("ellipsoid-touch", tmp_path, ("-0.01]", "-0.001]"))
    chosen = tmp_path / "chosen.toml"
    outcome, document = choose(case, "--tolerance", "5%", "-o", chosen)
    candidate = chosen_of(document)
    assert candidate["method"] == "linear-condensed" and candidate["mesh"] == "own mesh"
    assert candidate["error"] <= 0.05 and candidate["smallest_jacobian"] > 0.9
    _, golden = answer(case, "--method", "tl-mean-dilatation")
    _, u = answer(chosen)
    assert largest(u - golden, 0.001) == pytest.approx(candidate["error"], rel=1e-9)


def test_column_takes_one_nonlinear_point(tmp_path):
    """Small-strain methods are rejected as everything rotates; one point with control suffices.

    The first sufficient one in the order of costs is chosen. Costs are measured, so a test cannot
    know which of several similar ones that is. The chosen mesh may be coarser: its answer is
    compared at the user's nodes by other means.
    """
    case = copied("column", tmp_path)
    chosen = tmp_path / "chosen.toml"
    outcome, document = choose(case, "--tolerance", "2%", "--all", "-o", chosen)
    candidate = chosen_of(document)
    sufficient = [r for r in document["rungs"] if r["outcome"] in ("chosen", "sufficient")]
    assert sufficient[0] is candidate and all(r["error"] <= 0.02 for r in sufficient)
    # The cost of levels is only known afterwards.
    fixed = [r for r in sufficient if r["accuracy"] is None]
    costs = [r["seconds_per_simulated_second"] for r in fixed]
    assert costs == sorted(costs)
    words = {line.split()[0]: line for line in sandglass("methods").stdout.splitlines()}
    one_point = [r["method"] for r in sufficient if "one point" in words[r["method"]]]
    assert "tl-perturbation" in one_point
    assert not {"linear", "linear-condensed"} & {r["method"] for r in sufficient}
    small_strains = ("--methods", "linear", "linear-condensed")
    _, linear = choose(case, "--tolerance", "2%", *small_strains, code=1)
    computed = [r for r in linear["rungs"] if r["error"]]
    assert computed and all("small-strain theory" in r["reason"] for r in computed)
    nodes, golden = answer(case, "--method", "tl-mean-dilatation")
    points, u = answer(chosen)
    unit = np.hypot(0.5, 0.3)
    predicted = largest(on_lattice(points, u, nodes) - golden, unit)
    assert predicted == pytest.approx(candidate["error"], rel=1e-6)
    assert predicted <= 0.02


def test_ellipsoid_takes_the_adaptive_method_at_half_a_percent(tmp_path):
    case = copied("ellipsoid-indentation", tmp_path)
    chosen = tmp_path / "chosen.toml"
    outcome, document = choose(case, "--tolerance", "0.5%", "--against", "golden", "-o", chosen)
    candidate = chosen_of(document)
    tried = document["rungs"][: document["chosen"]]
    assert all(r["error"] > 0.005 and r["outcome"] == "refused" and r["reason"] for r in tried)
    assert {"linear", "linear-condensed", "tl-perturbation"} <= {r["method"] for r in tried}
    assert candidate["error"] <= 0.005 and candidate["method"] == "tl-adaptive"
    with h5py.File(ROOT / "reference" / "golden" / "ellipsoid-indentation.h5") as file:
        golden = file["displacement"][:]
    assert largest(answer(chosen)[1] - golden, 0.04) == pytest.approx(candidate["error"], rel=1e-9)


def test_says_nothing_where_the_mesh_is_the_limit(tmp_path):
    """No method can correct a mesh that is a percent off; a less accurate truth proves nothing."""
    case = copied("column", tmp_path)
    chosen = tmp_path / "chosen.toml"
    words = ("--tolerance", "0.001%", "--against", "truth", "-o", chosen)
    outcome, document = choose(case, *words, code=1)
    assert not chosen.exists() and document["chosen"] is None
    assert "no method suffices" in outcome.stdout and "was not written" in outcome.stdout
    words = " ".join(document["remarks"])
    assert "smaller errors cannot be shown" in words
    assert "no method can be more accurate" in words
    assert "the most accurate candidate" in words
    assert all(r["reason"] and r["outcome"] == "refused" for r in document["rungs"])
    assert all(remark in " ".join(outcome.stdout.split()) for remark in document["remarks"])


def test_without_a_stored_golden_it_is_the_same_choice_as_with_one(block):
    write_golden(block)
    words = (block, "--methods", "tl-perturbation", "--all", "--tolerance", "1e-9")
    _, computed = choose(*words, code=None)
    _, stored = choose(*words, "--against", "golden", code=None)
    errors = [
        {r["rung"]: r["error"] for r in document["rungs"] if r["mesh"] == "own mesh"}
        for document in (computed, stored)
    ]
    assert errors[0] == errors[1] and len(errors[0]) == 6


def test_a_mesh_from_a_file_stays_where_it_is(block, tmp_path):
    """The case is written to another folder and still finds its only mesh."""
    mesh = tmp_path / "mesh.h5"
    assert sandglass("mesh", block, "-o", mesh).returncode == 0
    before, rest = BLOCK.split("[mesh]")
    text = f'{before}[mesh]\nfile = "mesh.h5"\n\n[material]{rest.split("[material]")[1]}'
    case = tmp_path / "filed.toml"
    case.write_text(text)
    (tmp_path / "there").mkdir()
    chosen = tmp_path / "there" / "chosen.toml"
    outcome, document = choose(case, "--tolerance", "5%", "-o", chosen)
    assert document["other_meshes"] == []
    run = sandglass("run", chosen, code=0)
    assert chosen_of(document)["method"] in run.stdout


def test_the_written_case_is_the_users_own(block, tmp_path):
    chosen = tmp_path / "chosen.toml"
    assert sandglass("choose", block, "--tolerance", "2%", "-o", chosen).returncode == 0
    text = chosen.read_text()
    assert text.startswith("#") and "comments are not kept" in text
    for line in ("size = [0.1, 0.1, 0.2]", "young_modulus = 3000.0", "[method]"):
        assert line in text
    assert 'requirement = "A block is pulled and sheared."' in text


def test_run_takes_the_method_of_the_case_unless_specified(block):
    block.write_text(BLOCK + '\n[method]\nname = "tl-perturbation"\nkappa = 0.02\n')
    assert "tl-perturbation, kappa 0.02, double" in sandglass("run", block).stdout
    assert "tl-perturbation, kappa 0.03, " in sandglass("run", block, "-k", "0.03").stdout
    assert "(auto)" in sandglass("run", block, "-k", "auto").stdout
    # The case's kappa applies to its own method only.
    assert "tl-full, double" in sandglass("run", block, "-m", "tl-full").stdout
    updated = sandglass("run", block, "-m", "ul-perturbation").stdout
    assert "ul-perturbation, kappa 0.00649" in updated
    block.write_text(BLOCK + '\n[method]\nname = "tl-full"\nprecision = "float"\n')
    assert "tl-full, float" in sandglass("run", block).stdout
    assert "tl-full, double" in sandglass("run", block, "-p", "double").stdout


def test_a_motion_is_chosen_for_and_the_chosen_case_runs(tmp_path):
    """Every candidate that was tried has the time of its run next to the predicted one."""
    case, chosen = copied("loaded-block", tmp_path), tmp_path / "chosen.toml"
    names = ("tl-perturbation", "tl-stabilization-matrix", "linear-condensed")
    outcome, document = choose(case, "--methods", *names, "-o", chosen)
    best = document["rungs"][document["chosen"]]
    assert best["method"] == "tl-stabilization-matrix" and best["error"] < 0.01
    for candidate in document["rungs"]:
        moved = candidate["run_seconds_per_simulated_second"]
        assert (moved is None) == (
            candidate["outcome"] == "not tried" or "motion" in candidate["reason"]
        )
    assert sandglass("run", chosen).returncode == 0


@pytest.mark.parametrize(
    "budget, suffices", [("0.000000000001", False), ("10s", True), ("1e9us", True)]
)
def test_budgets_are_kept(block, budget, suffices):
    words = ("--methods", "linear", "--tolerance", "50%", "--budget", budget)
    _, document = choose(block, *words, code=0 if suffices else 1)
    for candidate in document["rungs"]:
        assert suffices or ("may take" in candidate["reason"] and candidate["error"] is None)


def rows_of(text):
    """Rows of the table: whether it is marked, and the words of the row."""
    rows = re.findall(r"^([> ]) ([a-z0-9][\w.% -]*(?:double|float)) +(\d+ .*)$", text, re.MULTILINE)
    return [(mark == ">", name, numbers.split()) for mark, name, numbers in rows]


@pytest.mark.parametrize("arguments", [(), ("--all",)])
def test_the_output_fits_a_terminal_and_agrees_with_the_file(tmp_path, arguments):
    """The chosen row is marked; rejected ones are counted by reason, and listed on request."""
    outcome, document = choose(copied("column", tmp_path), "--tolerance", "2%", *arguments)
    assert max(map(len, outcome.stdout.splitlines())) <= 100
    rows, best = rows_of(outcome.stdout), chosen_of(document)
    assert [name for marked, name, _ in rows if marked] == [best["rung"]]
    meshes = dict(re.findall(r"^mesh (\d+): ([^;\n]*)", outcome.stdout, re.MULTILINE))
    (numbers,) = [numbers for marked, _, numbers in rows if marked]
    assert meshes[numbers[0]] == best["mesh"]
    assert float(numbers[3]) == pytest.approx(best["seconds_per_simulated_second"], rel=5e-3)
    assert float(numbers[5]) == pytest.approx(100.0 * best["error"], rel=5e-3)
    groups = re.findall(r"^(\d+) rejected: (.*?):", outcome.stdout, re.MULTILINE)
    refused = [r for r in document["rungs"] if r["outcome"] == "refused"]
    for count, kind in groups:
        assert int(count) == sum(r["reason"].startswith(kind) for r in refused)
    assert sum(int(count) for count, _ in groups) == len(refused) > 0
    shown = [r for r in document["rungs"] if arguments or r["outcome"] == "chosen"]
    assert len(rows) == len(shown)
    not_tried = sum(r["outcome"] == "not tried" for r in document["rungs"])
    assert (f"{not_tried} costlier ones were not tried" in outcome.stdout) == (not arguments)


def test_the_note_on_the_reference_is_its_distance_from_the_stored_truth(tmp_path):
    """As on the page and by `sandglass score`; without a truth, as estimated with the golden."""
    case = copied("column", tmp_path)
    document = choose(case, "--methods", "linear", "--tolerance", "20%")[1]
    with h5py.File(ROOT / "reference/truth/column.h5") as file:
        truth = file["displacement"][:]
    with h5py.File(ROOT / "reference/golden/column.h5") as file:
        off = largest(file["displacement"][:] - truth, np.hypot(0.5, 0.3))
        estimated = file.attrs["own_error_max"]
    # The reference is computed here: within 1e-6 of the golden, as its own residual.
    assert document["reference"]["own_error"] == pytest.approx(off, abs=1e-6)
    assert abs(estimated - off) > 1e-4
    assert f"{100.0 * off:.3g} %" in document["remarks"][0]
    case.write_text(re.sub("^truth = .*", "", case.read_text(), flags=re.MULTILINE))
    document = choose(case, "--methods", "linear", "--tolerance", "20%")[1]
    assert document["reference"]["own_error"] == pytest.approx(estimated, rel=1e-12)


def test_ctrl_c_leaves_nothing(tmp_path):
    case = copied("ellipsoid-indentation", tmp_path)
    chosen, table = tmp_path / "chosen.toml", tmp_path / "choice.json"
    code, message = interrupted("choose", case, "--all", "-o", chosen, "--json", table)
    assert code == 3 and "interrupted" in message, message
    assert sorted(path.name for path in tmp_path.iterdir()) == ["ellipsoid-indentation.toml"]
