"""Implausible records: no page is made, and the message gives the reason.

Each test corrupts a sound document in the way that a likely mistake in a program would.
"""

import dataclasses

import pytest

from make_report import main
from sandglass_report.measured import Step
from sandglass_report.plausible import (
    RULES,
    Marks,
    bench_agrees,
    complaints,
    disturbed,
    seconds_are_those_of_the_step,
    seconds_can_be_waited_for,
    steps_are_of_soft_bodies,
    times_follow_operations,
    updated_form_costs_more,
)
from sandglass_report.points import Point

ELEMENTS = 1000
STEP = 4e-4  # s, mean of the motion
CHECKS = 6.0  # ns per element and step
# method -> (ns per element and step, operations), about as measured on an ellipsoid
METHODS = {
    "tl-none": (21.0, 430),
    "tl-perturbation": (23.0, 598),
    "ul-perturbation": (62.0, 1241),
    "tl-enhanced": (33.0, 939),
    "tl-full": (73.0, 2186),
    "tl-mean-dilatation": (77.0, 2202),
}
TABLE = {method: operations for method, (_, operations) in METHODS.items()}


def point(method, ns, operations, **changed):
    """A mark of a method on its own mesh."""
    known = {"case": "ball", "method": method, "kappa": None, "as_it_comes": True}
    known |= {"accuracy": None, "precision": "double", "mesh": "own mesh", "elements": ELEMENTS}
    known |= {"finding": "good", "ok": True, "ns": ns, "operations": operations}
    return Point(**(known | {"mean_step": STEP} | timed(ns, STEP) | changed))


def timed(ns, mean_step):
    """The costs that belong to a time per element and step."""
    step, checks = 1e-9 * ns * ELEMENTS, 1e-9 * CHECKS * ELEMENTS
    known = {"ns": ns, "step": step, "checks": checks, "mean_step": mean_step}
    return known | {"simulated": (step + checks) / mean_step}


def sound(**changed):
    """Plausible marks. changed: changes of single methods' points, with _ for -."""
    points = {method: point(method, *facts) for method, facts in METHODS.items()}
    for name, values in changed.items():
        method = name.replace("_", "-")
        points[method] = dataclasses.replace(points[method], **values)
    return tuple(points.values())


def steps_of_bench(factor=1.0):
    """Records of bench that agree with the points, or whose times are longer by a factor."""
    return tuple(
        Step("ball", ELEMENTS, m, "double", factor * ns, STEP, 1.0)
        for m, (ns, _) in METHODS.items()
    )


def broken(points, steps=(), table=TABLE):
    """The rules that marks break, and the complaints."""
    found = complaints(Marks(tuple(points), steps, table))
    return {rule for rule in RULES if rule.__doc__ in {words for words, _ in found}}, found


def test_measured_marks_are_plausible():
    assert broken(sound(), steps_of_bench()) == (set(), [])


def test_the_time_of_another_loop_is_noticed():
    """A past mistake: the time of an evaluation of the static search in place of a step's."""
    points = [dataclasses.replace(p, **timed(2400.0 + p.operations / 40, STEP)) for p in sound()]
    rules, found = broken(points, steps_of_bench())
    assert {bench_agrees, updated_form_costs_more, times_follow_operations} <= rules
    assert any("bench has" in words for _, words in found)


@pytest.mark.parametrize("factor", [0.7, 1.4])
def test_times_that_bench_does_not_have_are_noticed(factor):
    assert broken(sound(), steps_of_bench(1 / 1.25))[0] == set()
    assert broken(sound(), steps_of_bench(factor))[0] == {bench_agrees}


@pytest.mark.parametrize(
    ("factor", "noticed"), [(0.45, True), (0.6, False), (1.7, False), (2.2, True)]
)
def test_a_single_time_may_be_disturbed(factor, noticed):
    first, *others = steps_of_bench()
    steps = (dataclasses.replace(first, ns=factor * first.ns), *others)
    assert broken(sound(), steps)[0] == ({bench_agrees} if noticed else set())
    assert [p.method for p in disturbed(Marks(sound(), steps, TABLE))] == [first.method]


def test_the_step_of_another_state_is_noticed():
    """The step of the most deformed state instead of the motion's mean."""
    strained = sound(tl_perturbation={"mean_step": STEP / 15})
    assert broken(strained)[0] == {seconds_are_those_of_the_step}
    inverted = sound(tl_perturbation=timed(23.0, 1e-17))
    rules, found = broken(inverted)
    assert rules == {steps_are_of_soft_bodies, seconds_can_be_waited_for}
    assert all(words.startswith("ball, tl-perturbation, double, own mesh: ") for _, words in found)


def test_a_stiff_body_may_have_short_steps():
    """Steel in elements of a millimetre; its undeformed steps are short."""
    stiff = {"stable_step": 2e-7} | timed(23.0, 1.5e-7)
    slow = stiff | {"simulated": 3e6, "step": 3e6 * 1.5e-7, "checks": 0.0}
    for changed in (stiff, slow):
        points = [dataclasses.replace(point("tl-perturbation", 23.0, 598), **changed)]
        assert broken(points)[0] == set()
        points[0] = dataclasses.replace(points[0], stable_step=2e-3)
        assert steps_are_of_soft_bodies in broken(points)[0]
    lost = [dataclasses.replace(points[0], stable_step=2e-7, mean_step=1e-10)]
    assert steps_are_of_soft_bodies in broken(lost)[0]


def test_a_second_without_its_checks_is_noticed():
    short = sound(tl_perturbation={"simulated": 1e-9 * 23.0 * ELEMENTS / STEP})
    assert broken(short)[0] == {seconds_are_those_of_the_step}


def test_an_endless_second_is_noticed_without_a_step():
    known = dict.fromkeys(("step", "checks", "mean_step", "ns"))
    condensed = sound(tl_none=known | {"simulated": 1e30})
    assert broken(condensed)[0] == {seconds_can_be_waited_for}
    assert broken(sound(tl_none=known | {"simulated": 0.0}))[0] == {seconds_can_be_waited_for}
    assert broken(sound(tl_none=known | {"simulated": 3.0}))[0] == set()


@pytest.mark.parametrize("unit", [1e3, 1e-3, 1e9])
def test_the_unit_of_another_axis_is_noticed(unit):
    """Milliseconds instead of seconds, or the reverse, in a single number."""
    for name in ("mean_step", "simulated", "step"):
        points = [dataclasses.replace(p, **{name: unit * getattr(p, name)}) for p in sound()]
        assert seconds_are_those_of_the_step in broken(points)[0]


def test_the_updated_form_must_cost_more_than_the_total_one():
    points = sound(ul_perturbation=timed(33.0, STEP))
    assert broken(points)[0] == {updated_form_costs_more}
    assert broken(sound(ul_perturbation=timed(36.0, STEP)))[0] == set()


@pytest.mark.parametrize(("ns", "rules"), [(180.0, True), (35.0, True), (120.0, False)])
def test_times_far_from_the_operations_are_noticed(ns, rules):
    found, _ = broken(sound(tl_full=timed(ns, STEP)))
    assert (found == {times_follow_operations}) == rules


def test_operations_saved_on_equal_elements_are_not_held_against_the_others():
    """On a column of equal boxes tl-perturbation counts 343, but takes its usual time."""
    assert broken(sound(tl_perturbation={"operations": 343}))[0] == set()


def test_loads_in_steps_are_the_work_of_no_method():
    """On a beam under pressure steps take 48 ns more; with dead loads alone that is a fault."""
    slow = {m.replace("-", "_"): timed(ns + 48.0, STEP) for m, (ns, _) in METHODS.items()}
    points = sound(**slow)
    assert broken(points)[0] >= {times_follow_operations}
    assert complaints(Marks(points, (), TABLE, loaded=frozenset({"ball"}))) == []


@pytest.mark.parametrize(
    ("ns", "true"), [(24.0, True), (78.0, True), (10.0, False), (180.0, False)]
)
def test_the_adaptive_method_may_have_one_to_eight_points(ns, true):
    points = (*sound(), point("tl-adaptive", ns, 598))
    found, _ = broken(points, table=TABLE | {"tl-adaptive": 598})
    assert found == (set() if true else {times_follow_operations})


def test_other_meshes_precisions_and_machines_are_not_compared_with_bench():
    variants = ({"mesh": "coarser"}, {"precision": "float"}, {"elsewhere": "another machine"})
    for changed in variants:
        assert broken([point("tl-none", 900.0, 430, **changed)], steps_of_bench())[0] == set()


def test_an_error_to_another_reference_is_noticed(data, capsys):
    """Golden and truth are exchanged in one of the two commands."""
    measured_in(data)
    for record in data.records:
        record["truth"] = record["golden"] | {"max_relative_error": 0.05}
    data.write_verdicts()
    rows = [data.row("tl-full", 1e-6, 0.05, precision="float")]
    rows += [data.row("tl-full", 1e-6, 0.05, mesh="coarser"), data.row("tl-full", 1e-6, None)]
    data.write("curves/a.json", data.choices([*rows, data.row("tl-full", 1e-6, 0.002)]))
    data.make()
    data.write("curves/a.json", data.choices([*rows, data.row("tl-full", 1e-6, 0.05)]))
    data.page.unlink()
    assert main(data.arguments) == 2
    message = "column, tl-full, double, own mesh: error to the golden 0.002, but choose has 0.05"
    assert message in capsys.readouterr().err
    data.write("curves/a.json", data.choices([data.row("tl-full", 1e-6, 0.05)], "truth"))
    data.make()
    other = data.choices([data.row("tl-full", 1e-6, 0.05)]) | {"revision": "another"}
    data.write("curves/a.json", other)
    data.make()


def measured_in(data, **changed):
    """Replaces the case's records by those of METHODS, with other values for tl-none."""
    (data.folder / "results/column.tl-perturbation.0.02.h5").unlink()
    data.records = []
    for method, (ns, operations) in METHODS.items():
        step = 1e-9 * (ns + CHECKS) * len(data.cells)
        auto = {"kappa": 0.0065, "auto": True} if method == "tl-perturbation" else {}
        record = data.run(method, 0.002, **auto) | {
            "operations": operations,
            "check_ns_per_element_step": CHECKS,
            "mean_step_seconds": STEP,
        }
        record |= {"ns_per_element_step": ns, "seconds_per_simulated_second": step / STEP}
        data.records.append(record | (changed if method == "tl-none" else {}))
    data.limits = []
    data.write_verdicts()


def test_a_page_is_made_from_plausible_records(data):
    measured_in(data)
    data.make()


def test_no_page_is_made_from_implausible_records(data, capsys):
    measured_in(data, mean_step_seconds=1e-17, seconds_per_simulated_second=1e32)
    assert main(data.arguments) == 2
    message = capsys.readouterr().err
    assert message.startswith("error: ") and message.count("\n") == 1
    for words in ("column, tl-none, double, own mesh", "1e-17 s", "at least 1e-6 s", "1e+32 s"):
        assert words in message
    assert not data.page.exists()


def test_a_bench_of_another_revision_is_not_compared(data, capsys):
    measured_in(data)
    records = [data.timing("tl-none", 99.0, "column", 12)]
    data.write("bench.json", {"revision": "another", "records": records})
    data.make()
    data.write("bench.json", {"revision": "abc", "records": records})
    assert main(data.arguments) == 2
    assert (
        "column, tl-none, double, own mesh: 21 ns, but bench has 99 ns" in capsys.readouterr().err
    )
