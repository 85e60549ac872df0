"""sandglass bench: all variants are present, figures are consistent, wrong input is reported.

Times are not judged: only that figures exist, are positive and follow from each other.
"""

import os
import re

import pytest
from command_line import documented, methods, ran

FIGURES = """
ns_per_element_step ns_best ns_lower_quartile ns_upper_quartile check_ns_per_element_step
ratio_to_tl_perturbation step_p50_us step_p99_us step_max_us
operations_per_element_step bytes_per_element_step gflops fraction_of_peak gbs
fraction_of_bandwidth stream_gbs_at_working_set roofline_fraction
""".split()

# A condensed method answers directly and takes no steps in time.
WITHOUT_MOTION = {"linear-condensed"}
OF_MOTION = ("mean_step_seconds", "seconds_per_simulated_second")


@pytest.fixture(scope="module")
def tiny():
    """One short run of everything: its output and its file."""
    command = "bench --elements 64 --repetitions 1 --threads 1 2"
    outcome, document = documented(command, code=0)
    return outcome.stdout, document


def test_cubes_take_fewer_operations_and_bytes_than_other_bricks():
    command = "bench --elements 64 --cubes 64 --repetitions 1 --threads 1"
    _, document = documented(command, "--methods", "tl-perturbation", "tl-full", code=0)
    found = {(r["case"], r["method"]): r for r in document["records"]}
    assert set(found) == {(c, m) for c in ("box", "cubes") for m in ("tl-perturbation", "tl-full")}
    for figure in ("operations_per_element_step", "bytes_per_element_step"):
        assert found["cubes", "tl-perturbation"][figure] < found["box", "tl-perturbation"][figure]
        assert found["cubes", "tl-full"][figure] == found["box", "tl-full"][figure]


def test_every_method_in_every_variant(tiny):
    found = {(r["method"], r["kernel"], r["precision"], r["threads"]) for r in tiny[1]["records"]}
    numbers = [("pack", "double"), ("pack", "float")]
    assert found == {(m, *n, t) for m in methods() for n in numbers for t in (1, 2)}
    assert len(tiny[1]["records"]) == len(found)


def test_figures_are_there_and_positive(tiny):
    for record in tiny[1]["records"]:
        assert record["case"] == "box" and record["elements"] == 64 and record["nodes"] == 125
        assert record["status"] == "ok"
        assert 0.0 <= record["force_difference"] < record["force_limit"]
        assert record["steps_timed"] >= 1
        for figure in FIGURES:
            assert record[figure] > 0.0, (figure, record)
        for figure in OF_MOTION:
            assert record[figure] is None  # a box is not a case


def test_figures_follow_from_each_other(tiny):
    document = tiny[1]
    for r in document["records"]:
        threads, ns = str(r["threads"]), r["ns_per_element_step"]
        peak = document["peak_gflops"][r["precision"]][threads]
        assert r["ns_best"] <= r["ns_lower_quartile"] <= ns <= r["ns_upper_quartile"]
        assert r["step_p50_us"] <= r["step_p99_us"] <= r["step_max_us"]
        assert r["gflops"] == pytest.approx(r["operations_per_element_step"] / ns)
        assert r["gbs"] == pytest.approx(r["bytes_per_element_step"] / ns)
        assert r["fraction_of_peak"] == pytest.approx(r["gflops"] / peak)
        bandwidth = document["bandwidth_gbs"][threads]
        assert r["fraction_of_bandwidth"] == pytest.approx(r["gbs"] / bandwidth)
        bound = max(
            r["operations_per_element_step"] / peak,
            r["bytes_per_element_step"] / r["stream_gbs_at_working_set"],
        )
        assert r["roofline_fraction"] == pytest.approx(bound / ns)
        assert r["speedup_over_scalar_double"] is None  # sandglass-scalar measures it


def test_json_names_its_source(tiny):
    document = tiny[1]
    for name in ("version", "revision", "compiler", "build_flags", "processor"):
        assert document[name]
    assert document["machine"]["processors"] >= 1
    assert document["repetitions"] == 1


def test_json_has_the_width_of_packs(tiny):
    """From the compiler: machines with the same name and "-march=native" may differ."""
    flags = tiny[1]["build_flags"]
    arch = re.search(r"-march=[^;]+", flags).group()
    macros = ran("c++", arch, "-dM", "-E", "-x", "c++", os.devnull, check=True).stdout
    width = 8 if "__AVX512F__" in macros else 4 if "__AVX__" in macros else 2
    assert flags.endswith(f"; packs of {width} doubles")


def test_table_shows_every_method(tiny):
    for text in (*methods(), "box: 64 elements, 125 nodes", "1 thread: peak", "2 threads: peak"):
        assert text in tiny[0]


def test_table_fits_a_terminal_and_shows_every_figure(tiny):
    table, _ = tiny
    assert [line for line in table.splitlines() if len(line) > 110] == []
    heads = "".join(line for line in table.splitlines() if line.startswith(" "))
    for head in ("median", "q3", "s per", "p99", "counted", "of peak", "roofline"):
        assert heads.count(head) == 1


def test_quartiles_that_are_far_apart_are_warned_of(block):
    command = f"bench {block} --methods tl-full tl-none --threads 1 --repetitions 20"
    outcome, document = documented(command)
    records = document["records"]
    wide = [r for r in records if r["ns_upper_quartile"] > 1.3 * r["ns_lower_quartile"]]
    words = f"warning: q3 is more than 1.3 times q1 in {len(wide)} of {len(records)} rows: "
    assert (words in outcome.stderr) == bool(wide)
    assert ("warning" in outcome.stderr) == bool(wide)


def test_operations_are_those_of_the_flops_command(tiny):
    records = documented("flops", code=0)[1]["records"]
    counted = {
        r["method"]: r["total"] for r in records if r["form"] == "kernel" and r["part"] == "element"
    }
    (update,) = (r["total"] for r in records if r["form"] == "update")
    for record in tiny[1]["records"]:
        if record["method"] in WITHOUT_MOTION:
            # 125 nodes, two driven sets; the forces are a product with a matrix of order 6.
            assert record["operations_per_element_step"] * 64 == update * 125 * 2 + 2 * 6 * 6
        else:
            assert record["operations_per_element_step"] == counted[record["method"]]


def test_condensed_methods_are_left_out_of_large_meshes():
    choice = "--methods linear-condensed --precision double --threads 1 --repetitions 1"
    outcome, document = documented("bench --elements 20000 " + choice, code=0)
    (record,) = document["records"]
    assert record["status"].startswith("left out: ") and record["status"] in outcome.stdout
    assert record["ns_per_element_step"] is None


def test_a_case_and_a_choice(block):
    command = f"bench {block} --methods tl-full --precision float --threads 1 --repetitions 2"
    (record,) = documented(command, code=0)[1]["records"]
    assert (record["case"], record["elements"], record["kernel"]) == ("block", 16, "pack")
    assert record["precision"] == "float" and record["ratio_to_tl_perturbation"] is None


def test_forces_are_compared_with_doubles(block):
    command = f"bench {block} --methods tl-full --threads 1 --repetitions 1"
    double, single = documented(command, code=0)[1]["records"]
    assert (double["kernel"], single["kernel"]) == ("pack", "pack")
    assert double["force_difference"] == 0.0 and single["force_difference"] > 0.0


def test_rest(block):
    """Every method and precision, with ordered seconds; bench/ reads the solver's records."""
    outcome, document = documented("bench --rest", block, code=0)
    assert "block: 16 elements, 45 nodes" in outcome.stdout
    assert document["revision"] and document["processor"]
    found = [(r["case"], r["method"], r["precision"], r["threads"]) for r in document["records"]]
    default = ("tl-perturbation", "tl-mean-dilatation")
    assert found == [("block", m, p, 1) for m in default for p in ("double", "float")]
    for record in document["records"]:
        assert record["status"] == "ok" and record["method"] in outcome.stdout
        seconds = [record[f"seconds_to_{name}"] for name in ("1_percent", "0_1_percent", "rest")]
        assert 0 < seconds[0] <= seconds[1] <= seconds[2]
        # Checks and cycles are shares of the evaluations.
        for share in (seconds[0] / seconds[2], seconds[1] / seconds[2]):
            assert record["evaluations"] * share == pytest.approx(
                round(record["evaluations"] * share)
            )
        assert record["precision"] == "float" or record["residual"] < 1e-8


def test_a_missed_equilibrium_ends_with_3(block):
    block.write_text(block.read_text() + "\n[relaxation]\nmax_steps = 5\n")
    command = f"bench --rest {block} --methods tl-full --precision double"
    outcome, document = documented(command, code=3)
    assert "failed: no equilibrium after" in outcome.stdout
    assert "1 of 1 found no static equilibrium" in outcome.stderr
    (record,) = document["records"]
    assert record["seconds_to_rest"] is None and record["status"].startswith("failed: ")
