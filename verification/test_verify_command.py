"""`sandglass verify`: limits, references of the right case, every figure in JSON."""

import pytest
from command_line import BLOCK, LIMIT, ROOT, documented, methods, sandglass, write_golden


ELEMENTS = 16  # of the block


def check_step_cost(record):
    """A simulated second has steps and checks; with a condensed method, a thousand answers."""
    second, step = record["seconds_per_simulated_second"], record["mean_step_seconds"]
    ns, checks = record["ns_per_element_step"], record["check_ns_per_element_step"]
    if record["method"] == "linear-condensed":
        assert second > 0 and step is None and ns is None
        return
    if step is None:  # the motion fails
        assert second is None and record["step_remark"]
        return
    assert second == pytest.approx(1e-9 * (ns + checks) * ELEMENTS / step)
    assert 0 < record["ns_lower_quartile"] <= ns <= record["ns_upper_quartile"]


def test_verify_holds_and_writes_every_figure(block):
    write_golden(block)
    block.write_text(BLOCK + LIMIT.format(method="tl-mean-dilatation", below=1e-6))
    _, document = documented("verify", block, "--results", block.parent / "states", code=0)
    for key in ("revision", "build_flags", "processor"):
        assert document[key]
    records = document["records"]
    assert [r["method"] for r in records if r["kappa_is_auto"] or r["kappa"] is None] == methods()
    for record in records:
        assert record["case"] == "block" and record["precision"] == "double"
        if record["method"] == "ul-viscous":  # no static stiffness: listed as failed, not omitted
            assert record["finding"] in ("not at rest", "inverted")
            continue
        assert record["status"] == "ok"
        assert record["truth"] is None
        for figure in ("max_relative_error", "rms_relative_error"):
            assert record["golden"][figure] >= 0.0
        assert record["golden"]["profile_relative_error"] is None
        assert record["residual"] < 1e-8
        assert record["evaluations"] > 0 and record["equilibrium_seconds"] > 0
        assert record["steps"] is None and record["motion_seconds"] is None
        check_step_cost(record)
    perturbation = [r for r in records if r["method"] == "tl-perturbation"]
    assert [r["kappa"] for r in perturbation if not r["kappa_is_auto"]] == [0.01]
    assert [limit["holds"] for limit in document["limits"]] == [True]
    assert len(list((block.parent / "states").glob("*.h5"))) == len(records)


def test_verify_gives_the_same_figures_for_any_number_of_threads(block):
    write_golden(block)
    figures = []
    for threads in (1, 3):
        records = documented("verify", block, "-j", threads, code=0)[1]["records"]
        keys = ("method", "kappa", "evaluations", "golden", "residual")
        figures.append([[record[key] for key in keys] for record in records])
    assert figures[0] == figures[1]


def test_verify_in_float_gives_figures_and_checks_no_limit(block):
    """The figures correspond to a rounding of 6e-8, amplified by less than four decades."""
    write_golden(block)
    block.write_text(BLOCK + LIMIT.format(method="tl-mean-dilatation", below=1e-30))
    outcome, document = documented("verify --precision float", block, code=0)
    assert "the cases' limits are for double precision; none was checked in float" in outcome.stdout
    assert document["limits"] == []
    assert {r["precision"] for r in document["records"]} == {"float"}
    (same,) = (r for r in document["records"] if r["method"] == "tl-mean-dilatation")
    assert same["status"] == "ok" and 1e-9 < same["golden"]["max_relative_error"] < 6e-4


PLANE = 'shape = "plane"\npoint = [0, 0, 9]\nnormal = [0, 0, -1]\n'
LOADS = {
    None: "[[gravity]]\nvalue = [0, 0, -1.0]\n",
    "support": '[[support]]\nset = "side"\nstiffness = 100.0\n',
    "obstacle": '[[obstacle]]\nname = "plane"\nset = "side"\n' + PLANE,
}


@pytest.mark.parametrize("load", LOADS)
def test_loads_that_steps_compute_are_named(block, load):
    """Their work is part of a step's time, but of no method's operations."""
    text = BLOCK.replace("[sets]", "[sets]\nside = { x = [0.1, 0.1] }")
    text = text.replace("[comparison]", LOADS[load] + "[comparison]")
    block.write_text(text + LIMIT.format(method="tl-none", below=1.0))
    records = documented("verify --no-costs", block, code=1)[1]["records"]
    assert {record["load_in_steps"] for record in records} == {load}


def test_broken_limit_ends_with_1(block):
    write_golden(block)
    block.write_text(BLOCK + LIMIT.format(method="tl-none", below=1e-30))
    outcome = sandglass("verify", block, code=1)
    assert "BROKEN block tl-none" in outcome.stdout


def test_limit_without_a_golden_is_broken(block):
    block.write_text(BLOCK + LIMIT.format(method="tl-none", below=1.0))
    outcome = sandglass("verify", block, code=1)
    assert "no figure" in outcome.stdout


@pytest.mark.parametrize("attribute", ["mesh_hash", "case_hash"])
def test_golden_of_another_case_or_mesh_ends_with_2(block, attribute):
    write_golden(block, **{attribute: "0123456789abcdef"})
    outcome = sandglass("verify", block, code=2)
    assert f"{attribute} is 0123456789abcdef" in outcome.stderr
    assert "reference/regenerate block" in outcome.stderr


PUBLISHED = (ROOT / "verification/support/published.toml.in").read_text()


def test_published_values_in_tables_and_json(block):
    """A bar under a stress of 1e-6 of its modulus extends by that fraction of its length.

    At nu = 0 the foot does not restrain it. Nonlinearity is 1e-6 of that.
    """
    text = BLOCK.replace("poisson_ratio = 0.49", "poisson_ratio = 0.0")
    text = text[: text.rindex("[[displacement]]")]
    force = 1e-6 * 3000.0 * 0.01
    published = PUBLISHED.format(force=force, value=1e-6 * 0.2, limit="below = 1.001")
    block.write_text(text + published)
    outcome, document = documented("verify", block, code=0)
    assert document["records"] == []
    records = document["published"]
    assert [r["case"] for r in records] == ["block-soft"] * len(methods()) + ["block-hard"] * len(
        methods()
    )
    for record in records:
        (value,) = record["values"]
        assert record["status"] == "ok" and record["family"] == "block"
        assert value["ratio"] == pytest.approx(
            {"soft": 2.0, "hard": 1.0}[record["variants"][0]], rel=1e-5
        )
        assert value["published"] == 2e-7 and value["truth"] is None
    assert "block: computed over published (a calculation by hand)" in outcome.stdout
    rows = [line.split() for line in outcome.stdout.splitlines()]
    for method in methods():
        assert [method, "2.0000", "1.0000"] in rows
    block.write_text(text + published.replace("below = 1.001", "below = 0.5"))
    outcome = sandglass("verify", block, code=1)
    assert "BROKEN block-soft tl-full" in outcome.stdout
    assert "holds  block-hard tl-full" in outcome.stdout
    sandglass("verify", block.parent / "block-hard", code=0)


def test_truncated_golden_ends_with_2(block):
    write_golden(block)
    golden = block.parent / "golden.h5"
    golden.write_bytes(golden.read_bytes()[:1000])
    sandglass("verify", block, code=2, message="golden.h5: is not a complete HDF5 file")
