"""Points of the main chart: merging of data, Pareto fronts, and which costs count."""

import json

import pytest
from synthetic import DataSet

from sandglass_report.interactive import chart_data
from sandglass_report.verdicts import read_verdicts
from sandglass_report.measured import read_measured
from sandglass_report.points import CHOOSE, VERIFY, families, fronts, make_points, pareto_front
from sandglass_report.style import FLOOR, Palette


def points_of(data, *documents):
    """Points by method, and the list, of the data set with these files of `choose`."""
    for i, choices in enumerate(documents):
        data.write(f"curves/{i}.json", choices)
    verdicts = read_verdicts(data.folder / "verdicts.json")
    absent = data.folder / "absent"
    measured = read_measured(*2 * [absent], data.folder / "curves", absent, absent)
    points = make_points(verdicts.runs, {"column": 12}, measured, verdicts.provenance)
    return {p.method: p for p in points if p.as_it_comes and p.mesh == "own mesh"}, points


def test_a_run_is_a_point_with_its_costs_in_seconds(data):
    found, points = points_of(data)
    assert len(points) == 4
    point = found["tl-none"]
    assert point.step == pytest.approx(120e-9 * 12)
    assert point.checks == pytest.approx(40e-9 * 12)
    # At the mean step, not the undeformed one.
    assert point.simulated == pytest.approx((point.step + point.checks) / 8e-5)
    assert (point.equilibrium, point.evaluations) == (0.5, 100)
    assert point.golden["max"] == 0.2 and point.truth == {}


def test_a_failed_run_is_marked_and_has_no_time_to_equilibrium(data):
    point = points_of(data)[0]["tl-full"]
    assert not point.ok and point.equilibrium is None and point.finding == "failed: <inverted>"


def test_a_method_without_a_step_has_a_simulated_second_alone(data):
    step = ("ns_per_element_step", "ns_lower_quartile", "ns_upper_quartile", "mean_step_seconds")
    data.records[0] |= dict.fromkeys([*step, "check_ns_per_element_step"])
    data.write_verdicts()
    answer = data.row("tl-none", 1e-6, 0.2, step_size=None)
    point = points_of(data, data.choices([answer]))[0]["tl-none"]
    assert point.step is None and point.ns is None
    assert point.simulated == data.records[0]["seconds_per_simulated_second"]


def test_only_points_of_kappa_curves_are_not_default(data):
    _, points = points_of(data)
    assert [(p.kappa, p.as_it_comes) for p in points if p.method == "tl-perturbation"] == [
        (0.0065, True),
        (0.02, False),
    ]


def test_costs_of_verify_stand_and_choose_adds_missing_ones(data):
    rows = [data.row("tl-perturbation", 3e-6, 0.9), data.row("t4", 5e-6, 0.5)]
    truth = data.choices([data.row("t4", 4e-6, 0.07)], "truth")
    found, _ = points_of(data, data.choices(rows), truth)
    point = found["tl-perturbation"]
    assert point.step == pytest.approx(120e-9 * 12) and point.measured_by == VERIFY
    assert point.golden["max"] == 0.002  # verify's stands
    point = found["t4"]
    assert (point.step, point.simulated, point.mean_step) == (5e-6, 5e-3, 1e-3)  # the first one's
    assert point.ns == pytest.approx(5e-6 / 12 * 1e9) and point.measured_by == CHOOSE
    assert point.truth == {"max": 0.07}


def test_costs_are_never_scaled_to_those_of_others(data):
    rows = [data.row(m, 0.1e-6, 0.01) for m in ("tl-perturbation", "tl-none")]
    found, _ = points_of(data, data.choices(rows))
    assert [p.step for p in found.values()] == pytest.approx(3 * [120e-9 * 12])


@pytest.mark.parametrize("fact", ["revision", "processor"])
def test_times_of_another_machine_or_revision_are_marked_and_lead_nothing(data, fact):
    choices = data.choices([data.row("t4", 1e-9, 0.001)]) | {fact: "another"}
    _, points = points_of(data, choices)
    (t4,) = (p for p in points if p.method == "t4")
    assert "another" in t4.elsewhere
    leading = {points[i].method for positions in fronts(points).values() for i in positions}
    assert leading and "t4" not in leading


def test_other_meshes_and_precisions_are_points_of_their_own(data):
    rows = [
        data.row("tl-perturbation", 3e-6, 0.01),
        data.row("tl-perturbation", 2e-6, 0.01, precision="float"),
        data.row("tl-perturbation", 1e-6, 0.03, mesh="elements = [1, 1, 1]", elements=1),
    ]
    _, points = points_of(data, data.choices(rows))
    assert len(points) == 4 + 2


def test_the_golden_elements_answer_counts_as_the_golden(data):
    choices = data.choices([data.row("t4", 1e-6, 0.5)], "tl-mean-dilatation")
    point = points_of(data, choices)[0]["t4"]
    assert point.golden == {"max": 0.5}
    assert "golden_is" not in point.as_record()  # the case has one


def test_the_replacement_of_a_missing_golden_is_named(data):
    for record in data.records:
        record["golden"] = None
    data.write_verdicts()
    choices = data.choices([data.row("t4", 1e-6, 0.5)], "tl-mean-dilatation")
    record = points_of(data, choices)[0]["t4"].as_record()
    assert record["golden_is"] == "tl-mean-dilatation"
    assert record["finding"].endswith("(tl-mean-dilatation)")


def test_a_refusal_names_its_tolerance(data):
    locks = data.row("t4", 1e-6, 0.5, reason="it locks")
    strict = data.choices([locks, data.row("linear", 1e-6, 0.5)], tolerance=0.002)
    loose = data.choices([locks | {"reason": ""}], tolerance=0.04)
    truth = data.choices([locks | {"reason": "it is far"}], "truth", tolerance=0.04)
    found, _ = points_of(data, strict, loose, truth)
    assert found["t4"].found() == "enough for 4 %, not for 0.2 %: it locks (golden)"
    assert found["linear"].found() == "enough for 0.2 % (golden)"
    assert found["tl-none"].found() == "good"  # verify's


def test_a_choice_has_an_answer_when_any_candidate_has_one_but_a_failed_run_stays_failed(data):
    lost = data.choices([data.row("t4", 1e-6, None), data.row("linear", 1e-6, None)])
    rows = [data.row("t4", 1e-6, 0.5), data.row("tl-full", 1e-6, 0.5)]
    found, _ = points_of(data, lost, data.choices(rows, "truth"))
    assert {m: found[m].ok for m in ("t4", "linear", "tl-full")} == {
        "t4": True,
        "linear": False,
        "tl-full": False,
    }


def test_candidates_of_a_case_that_was_not_run_are_left_out(data):
    _, points = points_of(data, data.choices([data.row("t4", 1e-6, 0.5)], case="elsewhere"))
    assert len(points) == 4


@pytest.mark.parametrize(
    ("costs", "errors", "front"),
    [
        ([1, 2, 3], [0.3, 0.2, 0.1], [0, 1, 2]),
        ([3, 2, 1], [0.1, 0.2, 0.3], [2, 1, 0]),
        ([1, 2, 3], [0.1, 0.2, 0.3], [0]),
        ([1, 2, 3], [0.3, 0.3, 0.1], [0, 2]),
        ([1, 1], [0.2, 0.1], [1]),
        ([2, 1], [FLOOR / 100, FLOOR / 2], [1]),
        ([], [], []),
    ],
)
def test_pareto_front(costs, errors, front):
    assert pareto_front(costs, errors) == front


def test_no_other_point_beats_one_on_the_front_and_one_beats_each_that_is_not():
    import random

    numbers = random.Random(7)
    costs = [numbers.random() for _ in range(200)]
    errors = [numbers.random() for _ in range(200)]
    front = set(pareto_front(costs, errors))

    def is_beaten(i):
        others = (j for j in range(200) if j != i)
        return any(costs[j] <= costs[i] and errors[j] <= errors[i] for j in others)

    assert front == {i for i in range(200) if not is_beaten(i)}


def test_fronts_leave_out_kappa_curves_failures_and_what_a_view_hides(data):
    rows = [data.row("tl-perturbation", 1e-9, 0.9, precision="float")]
    rows.append(data.row("tl-perturbation", 2e-9, 0.5, mesh="coarser"))
    rows.append(data.row("tl-perturbation", 3e-9, 1e-4, kappa=0.003))  # better, but tuned
    _, points = points_of(data, data.choices(rows))
    found = fronts(points)

    def named(view):
        return [(points[i].precision, points[i].mesh, points[i].kappa) for i in found[view]]

    own, auto = "own mesh", 0.0065
    assert named("column|golden|max|step|all|all") == [
        ("float", own, None),
        ("double", "coarser", None),
        ("double", own, auto),
    ]
    assert named("column|golden|max|step|own|double") == [("double", own, auto)]
    assert not [view for view in found if "|truth|" in view]


def test_adaptive_points_are_lines_from_loose_to_strict(data):
    shares = (0.001, 0.1, 0.01)
    rows = [data.row("tl-adaptive", s, s, accuracy=s) for s in shares]
    rows.append(data.row("tl-adaptive", 1.0, 0.1, accuracy=0.1, precision="float"))
    _, points = points_of(data, data.choices(rows))
    (line,) = families(points)
    assert [points[i].accuracy for i in line] == [0.1, 0.01, 0.001]


def test_the_data_of_the_script_are_json_and_say_what_fails(data):
    data.records[0] |= {"finding": "hourglassing"}
    data.write_verdicts()
    _, points = points_of(data)
    palette = Palette(["tl-none", "tl-perturbation", "tl-full"])
    found = json.loads(json.dumps(chart_data(points, palette), allow_nan=False))
    fails = {p["method"]: p["fails"] for p in found["points"]}
    assert fails == {"tl-none": True, "tl-perturbation": False, "tl-full": True}
    marks = {(m["css"], m["symbol"]) for m in found["methods"].values()}
    assert len(marks) == 3


def test_rounding_keeps_what_a_chart_shows(data):
    assert isinstance(data, DataSet)
    _, points = points_of(data, data.choices([data.row("t4", 1.23456789e-6, 0.5)]))
    assert next(p for p in points if p.method == "t4").as_record()["step"] == 1.2346e-6
