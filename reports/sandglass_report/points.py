"""The points of the main chart: every method, mesh and precision with all errors and costs.

Runs of `verify` provide the errors to both references; `choose` provides other precisions, coarser
meshes, the adaptive family, and costs that were measured one at a time on an idle machine.
Data of the same choice are merged into one point.
"""

import itertools
import statistics
from dataclasses import asdict, dataclass, field

from sandglass_report import style
from sandglass_report.verdicts import REFERENCES
from sandglass_report.measured import OWN_MESH, STAND_IN
from sandglass_report.style import exact_percent

FIGURES = ("max", "profile", "rms")
COSTS = ("step", "simulated", "rest")
MESHES = ("all", "own")
PRECISIONS = ("all", "double")
VERIFY = "verify, other runs beside it"
CHOOSE = "choose"
SCALED = "verify, scaled to what choose measures"


@dataclass
class Point:
    """One choice on one case: errors (fractions, by figure) and costs (s); None if unknown."""

    case: str
    method: str
    kappa: float | None
    as_it_comes: bool  # not a point of a kappa curve
    accuracy: float | None  # asked of an adaptive method
    precision: str
    mesh: str
    elements: int | None
    finding: str
    ok: bool
    golden: dict = field(default_factory=dict)
    golden_is: str | None = None  # the method that stands for a golden that is not stored
    truth: dict = field(default_factory=dict)
    step: float | None = None
    simulated: float | None = None
    rest: float | None = None
    measured_by: str = VERIFY
    judged: dict = field(default_factory=dict)  # (reference, tolerance) -> why it is not enough

    def error(self, reference, figure):
        """One error, or None."""
        return getattr(self, reference).get(figure)

    def found(self):
        """The finding of verify or, if there is none, of choose, preferably against the golden."""
        if self.finding or not self.judged:
            return self.finding
        name = min(reference for reference, _ in self.judged)
        told = {t: why for (reference, t), why in self.judged.items() if reference == name}
        enough = [t for t, why in told.items() if not why]
        words = [f"enough for {exact_percent(min(enough))}"] if enough else []
        beyond = max((t for t in told if told[t]), default=None)
        if beyond is not None:
            words.append(f"not for {exact_percent(beyond)}: {told[beyond]}")
        return ", ".join(words) + f" ({self.golden_is or name})"

    def as_record(self):
        """The point as read by the page's script: rounded, without unknown values."""
        rounded = {k: _rounded(v) for k, v in asdict(self).items() if k != "judged"}
        rounded["finding"] = self.found()
        return {k: v for k, v in rounded.items() if v not in (None, {})}


def make_points(runs, elements, measured):
    """Points of all cases of the verdicts, grouped by case.

    runs: of the verdicts. elements: case -> number of elements of its mesh, or None.
    measured: the files of other commands.
    """
    points = {}
    with_golden = {run.case for run in runs if run.golden is not None}
    for run in runs:
        kappa = None if run.is_main else run.kappa
        points[run.case, run.method, kappa, run.precision, OWN_MESH, None] = _of_run(
            run, elements.get(run.case)
        )
    loaded = {key: point.step for key, point in points.items() if point.step is not None}
    for rung in measured.rungs:
        if rung.case in elements and rung.reference in REFERENCES:
            key = rung.case, rung.method, rung.kappa, rung.precision, rung.mesh, rung.accuracy
            point = points.setdefault(key, _of_rung(rung))
            _add_rung(point, rung)
            if rung.stands_in and rung.case not in with_golden:
                point.golden_is = STAND_IN
    _bring_to_one_scale(points, loaded)
    for rest in measured.rests:
        point = points.get((rest.case, rest.method, None, rest.precision, OWN_MESH, None))
        if point and rest.seconds is not None:
            point.rest = rest.seconds
    order = {case: i for i, case in enumerate(elements)}
    return sorted(points.values(), key=lambda point: order[point.case])


def _bring_to_one_scale(points, loaded):
    """Scales the costs measured only by verify to those of choose, if both measured a case.

    loaded: key of a point -> s, as measured by verify. Its runs share the machine, so their times
    are too long by about the same factor, which is the median over the points that both measured.
    """
    factors = {}
    for key, step in loaded.items():
        if points[key].measured_by == CHOOSE:
            factors.setdefault(points[key].case, []).append(points[key].step / step)
    for key in loaded:
        point = points[key]
        if point.measured_by == VERIFY and point.case in factors:
            factor = statistics.median(factors[point.case])
            point.step *= factor
            point.simulated = None if point.simulated is None else point.simulated * factor
            point.measured_by = SCALED


def _of_run(run, elements):
    """The point of a run; its costs were measured while other runs were in progress."""
    step = None if elements is None else 1e-9 * run.ns_per_element_step * elements
    known = step is not None and step > 0
    return Point(
        run.case,
        run.method,
        run.kappa,
        run.is_main,
        None,
        run.precision,
        OWN_MESH,
        elements,
        finding=(run.finding or "no golden to compare with") if run.ok else run.status,
        ok=run.ok,
        golden=_errors(run.golden),
        truth=_errors(run.truth),
        step=step if known else None,
        simulated=step / run.stable_step if known and run.stable_step > 0 else None,
        rest=run.wall_seconds if run.ok else None,
    )


def _of_rung(rung):
    return Point(
        rung.case,
        rung.method,
        rung.kappa,
        rung.kappa is None,
        rung.accuracy,
        rung.precision,
        rung.mesh,
        rung.elements,
        finding="",
        ok=False,  # until a rung brings an answer
    )


def _add_rung(point, rung):
    """Adds the data of a rung to a point. The cost measured first is kept."""
    point.judged.setdefault((rung.reference, rung.tolerance), rung.reason)
    if rung.error is not None:
        getattr(point, rung.reference).setdefault("max", rung.error)
        point.ok = point.ok or not point.finding
    if rung.step is not None and point.measured_by != CHOOSE:
        point.step, point.simulated, point.measured_by = rung.step, rung.simulated, CHOOSE


def _errors(accuracy):
    if accuracy is None:
        return {}
    errors = {figure: getattr(accuracy, figure) for figure in FIGURES}
    return {figure: error for figure, error in errors.items() if error is not None}


def _rounded(value):
    """A number rounded to five digits, more than a chart can show."""
    if isinstance(value, float):
        return float(f"{value:.5g}")
    return {k: _rounded(v) for k, v in value.items()} if isinstance(value, dict) else value


def pareto_front(costs, errors):
    """Indices of the points that no other beats in cost and error, cheapest first.

    Errors below style.FLOOR count as equal; among equals the cheaper one is kept.
    """
    order = sorted(range(len(costs)), key=lambda i: (costs[i], max(errors[i], style.FLOOR)))
    front, least = [], float("inf")
    for i in order:
        error = max(errors[i], style.FLOOR)
        if error < least:
            front.append(i)
            least = error
    return front


def fronts(points):
    """The front of every view: 'case|reference|figure|cost|mesh|precision' -> positions.

    A front consists of methods with their default settings that come to rest.
    """
    found = {}
    for case in dict.fromkeys(point.case for point in points):
        own = [i for i, p in enumerate(points) if p.case == case and p.as_it_comes and p.ok]
        for view in itertools.product(REFERENCES, FIGURES, COSTS, MESHES, PRECISIONS):
            positions = _front_of_view(points, own, *view)
            if positions:
                found["|".join((case, *view))] = positions
    return found


def _front_of_view(points, positions, reference, figure, cost, mesh, precision):
    seen = [
        i
        for i in positions
        if points[i].error(reference, figure) is not None
        and getattr(points[i], cost) is not None
        and (mesh == "all" or points[i].mesh == OWN_MESH)
        and (precision == "all" or points[i].precision == precision)
    ]
    costs = [getattr(points[i], cost) for i in seen]
    errors = [points[i].error(reference, figure) for i in seen]
    return [seen[i] for i in pareto_front(costs, errors)]


def families(points):
    """Lines of the adaptive methods: lists of indices from loose to strict accuracy.

    One for each case, method, precision and mesh with at least two accuracies.
    """
    groups = {}
    for i, p in enumerate(points):
        if p.accuracy is not None and p.ok:
            groups.setdefault((p.case, p.method, p.precision, p.mesh), []).append(i)
    lines = groups.values()
    return [sorted(g, key=lambda i: -points[i].accuracy) for g in lines if len(g) > 1]
