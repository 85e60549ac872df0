"""Plausibility of the chart's marks: no page is made with an impossible one.

Each rule below is a function of Marks that yields a complaint for every mark that breaks it; its
docstring is the rule. A cost of another loop, a step of another state or a value in another unit
breaks at least one.
"""

import statistics
from collections import defaultdict
from dataclasses import dataclass, field

from common.errors import InputError
from sandglass_report import paper
from sandglass_report.measured import BENCH, OWN_MESH
from sandglass_report.provenance import elsewhere
from sandglass_report.style import FLOOR

# Soft bodies of millimetres and more: a wave of 10 m/s takes 0.1 ms through an element of 1 mm. A
# hundredth of that is a mistake. A stiff body has short steps even when undeformed, and the
# mean of its motion is not far below them.
LEAST_STEP = 1e-6  # s
LEAST_SHARE = 0.01  # of the undeformed step
# Eleven days for a second: nobody waits for that.
MOST_WALL = 1e6  # s per simulated second
# Two measurements of many loops on one machine agree in the median; that of a single loop may be
# disturbed by other programs, of which two may share a processor.
BENCH_AGREES = 1.3
DISTURBED_AT_MOST = 2.0
# The updated form computes the gradients of the shape functions anew in each step.
UPDATED_AT_LEAST = 1.5
OPERATIONS_AGREE = 2.0
ADAPTIVE, EIGHT_POINTS = "tl-adaptive", "tl-mean-dilatation"
AS_IT_COMES = OWN_MESH, "double", None, None  # mesh, numbers, kappa and accuracy of a candidate
COUNTED = "kernel", "element"  # form and part of the flop table
# One division, or one relaxation to 1e-8 of the forces: differences are those of printed digits.
SAME = 0.01


@dataclass(frozen=True)
class Marks:
    """The data that the rules check.

    points: of the main chart. steps: of bench, and candidates: of choose, if of the same origin.
    table: method -> operations of an element and step in the flop table. loaded: cases with
    pressures, supports or contact, whose time is part of a step and in no count of a method.
    """

    points: tuple
    steps: tuple = ()
    table: dict = field(default_factory=dict)
    candidates: tuple = ()
    loaded: frozenset = frozenset()

    def own(self):
        """The points of the methods with default settings, on the cases' own meshes, in double."""
        return [
            p
            for p in self.points
            if p.as_it_comes and p.mesh == OWN_MESH and p.precision == "double" and p.counts
        ]

    def least_step(self, case):
        """The shortest possible mean step of a case's body, s."""
        undeformed = [p.stable_step for p in self.points if p.case == case and p.stable_step]
        return min(LEAST_STEP, LEAST_SHARE * min(undeformed, default=1.0))

    def work(self, point):
        """(least, most) operations per element and step: of the flop table or, if more, the case's.

        On a mesh of equal elements tl-perturbation counts half of the table's, but saves hardly any
        time: loading and storing the nodes remains. The table's count is therefore the least. The
        table counts the adaptive method with one point, and in motion elements have up to eight.
        """
        least = max(self.table[point.method], point.operations or 0)
        eight = self.table.get(EIGHT_POINTS, least) if point.method == ADAPTIVE else least
        return least, max(least, eight)

    def with_dead_loads_only(self):
        """by_case() of the cases whose steps are the work of the methods alone."""
        return {case: of for case, of in self.by_case().items() if case not in self.loaded}

    def by_case(self):
        """case -> {method: Point} of own() with a time of a step."""
        cases = defaultdict(dict)
        for p in self.own():
            if p.ns is not None and p.accuracy is None:
                cases[p.case][p.method] = p
        return cases


def steps_are_of_soft_bodies(marks):
    """A mean step is at least 1e-6 s, or a hundredth of the undeformed one"""
    least = {case: marks.least_step(case) for case in {p.case for p in marks.points}}
    for p in marks.points:
        if p.mean_step is not None and not p.mean_step >= least[p.case]:
            yield f"{p.name}: mean step {p.mean_step:g} s"


def seconds_can_be_waited_for(marks):
    """A simulated second takes less than 1e6 s of wall time, unless undeformed steps are short"""
    for p in marks.points:
        most = MOST_WALL * LEAST_STEP / marks.least_step(p.case)
        if p.simulated is not None and not 0 < p.simulated < most:
            yield f"{p.name}: {p.simulated:g} s per simulated second"


def seconds_are_those_of_the_step(marks):
    """The time of a simulated second is that of step and checks over the mean step"""
    for p in marks.points:
        if None in (p.step, p.mean_step, p.simulated):
            continue
        checks = p.checks or 0.0
        expected = (p.step + checks) / p.mean_step
        if not abs(p.simulated / expected - 1) <= SAME:
            yield (
                f"{p.name}: {p.simulated:g} s per simulated second, but {p.step:g} s for a step, "
                f"{checks:g} s for checks and a mean step of {p.mean_step:g} s give "
                f"{expected:g} s"
            )


def _over_bench(marks):
    """(mark, its time over that of bench on this machine and revision) for all that both have."""
    timed = {(s.case, s.method): s.ns for s in marks.steps if s.precision == "double"}
    for p in marks.own():
        ns = timed.get((p.case, p.method))
        if ns and p.ns:
            yield p, p.ns / ns


def _within(ratio, factor):
    return 1 / factor <= ratio <= factor


def bench_agrees(marks):
    """Times per element and step agree with bench: each within a factor of 2, the median by 30 %"""
    ratios = list(_over_bench(marks))
    median = statistics.median(ratio for _, ratio in ratios) if ratios else 1.0
    for p, ratio in ratios:
        if not (_within(ratio, DISTURBED_AT_MOST) and _within(median, BENCH_AGREES)):
            yield f"{p.name}: {p.ns:.4g} ns, but bench has {p.ns / ratio:.4g} ns"


def disturbed(marks):
    """The marks whose times differ by more than 30 % from bench's: the machine was busy."""
    return [p for p, ratio in _over_bench(marks) if not _within(ratio, BENCH_AGREES)]


def updated_form_costs_more(marks):
    """A step of ul-perturbation takes at least 1.5 times as long as one of tl-perturbation"""
    for methods in marks.with_dead_loads_only().values():
        total, updated = methods.get(paper.METHOD), methods.get(paper.UPDATED)
        if total and updated and not updated.ns >= UPDATED_AT_LEAST * total.ns:
            yield f"{updated.name}: {updated.ns:.4g} ns, {total.method} {total.ns:.4g} ns"


def times_follow_operations(marks):
    """Times per step over that of tl-perturbation are those of operations within a factor of two"""
    for methods in marks.with_dead_loads_only().values():
        counted = [p for p in methods.values() if p.method in marks.table]
        unit = next((p for p in counted if p.method == paper.METHOD), None)
        for p in counted if unit else ():
            time = p.ns / unit.ns
            least, most = (work / marks.work(unit)[0] for work in marks.work(p))
            if not least / OPERATIONS_AGREE <= time <= most * OPERATIONS_AGREE:
                yield (
                    f"{p.name}: {time:.3g} times the time of {unit.method}, but {least:.3g} times "
                    "its operations"
                )


def references_are_the_same(marks):
    """The errors of verify and choose to one reference agree within 1 %"""
    runs = {(p.case, p.method): p for p in marks.own() if p.ok and p.finding}
    for candidate in marks.candidates:
        variant = candidate.mesh, candidate.precision, candidate.kappa, candidate.accuracy
        p = runs.get((candidate.case, candidate.method)) if variant == AS_IT_COMES else None
        error = p.error(candidate.reference, "max") if p else None
        if None in (error, candidate.error):
            continue
        if abs(candidate.error - error) > SAME * error + FLOOR:
            yield (
                f"{p.name}: error to the {candidate.reference} {error:.4g}, but choose has "
                f"{candidate.error:.4g}"
            )


RULES = (
    steps_are_of_soft_bodies,
    seconds_can_be_waited_for,
    seconds_are_those_of_the_step,
    updated_form_costs_more,
    times_follow_operations,
    bench_agrees,
    references_are_the_same,
)


def complaints(marks):
    """(rule in words, what breaks it) for all rules."""
    return [(rule.__doc__, found) for rule in RULES for found in rule(marks)]


def require_plausible(points, measured, own, loaded):
    """Raises InputError naming the first marks that cannot be true, and the rules they break.

    points: of the main chart. own: machine and revision of the verdicts. loaded: see Marks. Returns
    the marks of which one of two measurements was disturbed.
    """
    same = not elsewhere(measured.facts_of(BENCH), own)
    table = {c.method: c.total for c in measured.counts if (c.form, c.part) == COUNTED}
    candidates = tuple(c for c in measured.candidates if not elsewhere(c.facts, own))
    marks = Marks(tuple(points), measured.steps if same else (), table, candidates, loaded)
    found = complaints(marks)
    if found:
        listed = "; ".join(f"{mark} [{rule}]" for rule, mark in found[:3])
        more = f"; and {len(found) - 3} more" if len(found) > 3 else ""
        raise InputError(
            f"the chart has marks that cannot be true: {listed}{more}; remedy: if the machine was "
            "busy, run `bash ci/verify` again while it is idle; `bash ci/verify accuracy` makes a "
            "page without times"
        )
    return disturbed(marks)
