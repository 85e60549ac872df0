"""The points of the main chart: every method, mesh and precision with all errors and costs.

Runs of `verify` provide the errors to both references and the costs of every method on the case's
own mesh; `choose` provides other precisions, coarser meshes and the adaptive family. Data of the
same choice are merged into one point; costs are as measured, never scaled.
"""

import itertools
from dataclasses import asdict, dataclass, field

from sandglass_report import style
from sandglass_report.measured import OWN_MESH, STAND_IN
from sandglass_report.provenance import elsewhere
from sandglass_report.quantities import COSTS, FIGURES
from sandglass_report.style import exact_percent
from sandglass_report.verdicts import REFERENCES

MESHES = ("all", "own")
PRECISIONS = ("all", "double")
VERIFY = "sandglass verify"
CHOOSE = "sandglass choose"
# Fields that a Point shares with its Run or its Candidate.
OF_RUN = "case method kappa precision ok ns mean_step step_remark simulated operations".split()
OF_CANDIDATE = "case method kappa accuracy precision mesh elements".split()


@dataclass
class Point:
    """One choice on one case: errors (fractions, by figure) and costs; None if unknown.

    step, checks, simulated, equilibrium, mean_step: s, as defined in quantities.py; of the whole
    mesh.
    """

    case: str
    method: str
    kappa: float | None
    as_it_comes: bool  # default settings, not a point of a kappa curve
    accuracy: float | None  # requested of an adaptive method
    precision: str
    mesh: str
    elements: int | None
    finding: str
    ok: bool
    golden: dict = field(default_factory=dict)
    golden_is: str | None = None  # the method that replaces a missing golden
    truth: dict = field(default_factory=dict)
    ns: float | None = None  # per element and step
    step: float | None = None
    checks: float | None = None
    mean_step: float | None = None
    step_remark: str = ""
    simulated: float | None = None
    equilibrium: float | None = None
    evaluations: int | None = None
    operations: int | None = None
    stable_step: float | None = None  # s, undeformed
    measured_by: str = VERIFY
    elsewhere: str = ""  # machine and revision of its times if they are not those of the page
    group: str | None = None  # the name of its switch, if not the method
    judged: dict = field(default_factory=dict)  # (reference, tolerance) -> why it is not enough

    @property
    def name(self):
        """Case, method and variant, for messages."""
        kappa = f"kappa {self.kappa:g}" if self.kappa is not None else ""
        asked = f"accuracy {exact_percent(self.accuracy)}" if self.accuracy else ""
        words = (self.case, self.method, kappa, asked, self.precision, self.mesh)
        return ", ".join(word for word in words if word)

    @property
    def counts(self):
        """Whether its times may be compared with those of the page's own runs."""
        return not self.elsewhere

    def error(self, reference, figure):
        """One error, or None."""
        return getattr(self, reference).get(figure)

    def found(self):
        """The finding of verify or, if there is none, of choose, preferably against the golden."""
        if self.finding or not self.judged:
            return self.finding
        name = min(reference for reference, _ in self.judged)
        reasons = {t: why for (reference, t), why in self.judged.items() if reference == name}
        enough = [t for t, why in reasons.items() if not why]
        words = [f"enough for {exact_percent(min(enough))}"] if enough else []
        beyond = max((t for t in reasons if reasons[t]), default=None)
        if beyond is not None:
            words.append(f"not for {exact_percent(beyond)}: {reasons[beyond]}")
        return ", ".join(words) + f" ({self.golden_is or name})"

    def as_record(self):
        """The point as read by the page's script: rounded, without unknown values."""
        rounded = {k: _rounded(v) for k, v in asdict(self).items() if k != "judged"}
        rounded["finding"] = self.found()
        return {k: v for k, v in rounded.items() if v not in (None, "", {})}


def make_points(runs, elements, measured, own):
    """Points of all cases of the verdicts, grouped by case.

    runs: of the verdicts. elements: case -> number of elements of its mesh, or None.
    measured: the files of other commands. own: machine and revision of the verdicts.
    """
    points = {}
    with_golden = {run.case for run in runs if run.golden is not None}
    for run in runs:
        kappa = None if run.is_main else run.kappa
        points[run.case, run.method, kappa, run.precision, OWN_MESH, None] = _of_run(
            run, elements.get(run.case)
        )
    for c in measured.candidates:
        if c.case in elements and c.reference in REFERENCES:
            key = c.case, c.method, c.kappa, c.precision, c.mesh, c.accuracy
            point = points.setdefault(key, _of_candidate(c))
            _add_candidate(point, c, own)
            if c.stands_in and c.case not in with_golden:
                point.golden_is = STAND_IN
    order = {case: i for i, case in enumerate(elements)}
    return sorted(points.values(), key=lambda point: order[point.case])


def _of_run(run, elements):
    """The point of a run."""
    return Point(
        **{name: getattr(run, name) for name in OF_RUN},
        as_it_comes=run.is_main,
        accuracy=None,
        mesh=OWN_MESH,
        elements=elements,
        finding=(run.finding or "no golden to compare with") if run.ok else run.status,
        golden=_errors(run.golden),
        truth=_errors(run.truth),
        step=_of_mesh(run.ns, elements),
        checks=_of_mesh(run.check_ns, elements),
        equilibrium=run.equilibrium if run.ok else None,
        evaluations=run.evaluations if run.ok else None,
        stable_step=run.stable_step or None,
    )


def _of_mesh(ns, elements):
    """A time per element in seconds for the whole mesh; None if one is unknown."""
    return None if ns is None or elements is None else 1e-9 * ns * elements


def _of_candidate(candidate):
    """The point of a candidate without a run; it is ok once a candidate has an answer."""
    same = {name: getattr(candidate, name) for name in OF_CANDIDATE}
    return Point(**same, as_it_comes=candidate.kappa is None, finding="", ok=False, measured_by="")


def _add_candidate(point, candidate, own):
    """Adds the data of a candidate to a point. The cost measured first is kept."""
    point.judged.setdefault((candidate.reference, candidate.tolerance), candidate.reason)
    if candidate.error is not None:
        getattr(point, candidate.reference).setdefault("max", candidate.error)
        point.ok = point.ok or not point.finding
    if candidate.step is not None and point.step is None and point.simulated is None:
        point.simulated = candidate.simulated
        if candidate.step_size is not None:  # a condensed answer is no step
            point.step, point.ns = candidate.step, 1e9 * candidate.step / candidate.elements
            point.checks = candidate.checks
            point.mean_step, point.step_remark = candidate.step_size, candidate.step_remark
        point.measured_by, point.elsewhere = CHOOSE, elsewhere(candidate.facts, own)


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

    A front consists of methods with their default settings that come to rest, timed on the machine
    and revision of the page.
    """
    found = {}
    for case in dict.fromkeys(point.case for point in points):
        own = [i for i, p in enumerate(points) if p.case == case and may_lead(p)]
        for view in itertools.product(REFERENCES, FIGURES, COSTS, MESHES, PRECISIONS):
            positions = _front_of_view(points, own, *view)
            if positions:
                found["|".join((case, *view))] = positions
    return found


def may_lead(point):
    """Whether a point may be on a front or in a headline."""
    return point.as_it_comes and point.ok and point.counts


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
