"""The rules that compare figures with the baseline. Pure functions."""

import math
from dataclasses import dataclass

from .interval import FEWEST
from .records import OF_MACHINE

# One build reproduces its errors exactly; another compiler or instruction set rounds differently,
# and relaxation ends elsewhere. README.md states how much this was seen to change errors.
RELATIVE = 1e-3
FLOOR = {"double": 2e-7, "float": 1e-4}  # fractions of the largest imposed displacement
SPEED_LIMIT = 0.01  # largest gap allowed between the baseline's interval and one above it

SAME, BETTER, WORSE, BROKEN, VANISHED, NEW, NOISY, UNGATED = (
    "same",
    "better",
    "WORSE",
    "BROKEN",
    "VANISHED",
    "new",
    "too noisy to tell",
    "not gated",
)
FAILING = (WORSE, BROKEN, VANISHED)


@dataclass(frozen=True)
class Outcome:
    """The outcome of the comparison of one figure."""

    area: str
    name: str
    figure: str
    verdict: str
    baseline: object = None
    found: object = None
    reason: str = ""

    @property
    def fails(self):
        """Whether it is a regression."""
        return self.verdict in FAILING


def judge_status(baseline, found):
    """Compares the status of a run: 'ok' or 'failed'."""
    if baseline == found:
        return SAME, ""
    return (WORSE, "no longer comes to rest") if found == "failed" else (BETTER, "comes to rest")


def judge_exact(baseline, found):
    """Compares a count that does not depend on the machine: fewer is better."""
    if found == baseline:
        return SAME, ""
    return (WORSE if found > baseline else BETTER), f"{found - baseline:+g}; must be equal"


def judge_error(baseline, found, precision):
    """Compares an error: a fraction of the largest imposed displacement."""
    margin = RELATIVE * baseline + FLOOR[precision]
    if abs(found - baseline) <= margin:
        return SAME, ""
    reason = f"{found - baseline:+.2e}; may rise by {margin:.1e}"
    return (WORSE if found > baseline else BETTER), reason


def judge_ratio(baseline, found):
    """Compares two Intervals of a ratio of times: worse lies wholly above, by SPEED_LIMIT."""
    line = baseline.high * (1.0 + SPEED_LIMIT)

    def change(value):
        return f"{100 * (value / baseline.median - 1):+.1f} %"

    if math.isinf(found.high):
        return NOISY, f"{change(found.median)}, from fewer than {FEWEST} processes"
    if found.low > line:
        return WORSE, f"{change(found.median)}; {change(found.low)} at least"
    if found.high > line:
        return NOISY, f"{change(found.median)}; up to {change(found.high)} cannot be excluded"
    if found.high < baseline.low / (1.0 + SPEED_LIMIT):
        return BETTER, change(found.median)
    return SAME, ""


def judge_promise(figure, found):
    """Checks rules that do not depend on the baseline; None if there is none."""
    if figure == "differs":
        return (BROKEN, found) if found else (SAME, "")
    return None


def judge(area, name, figure, baseline, found):
    """Verdict and reason for a figure present in both."""
    if figure == "status":
        return judge_status(baseline, found)
    if area == "accuracy":
        return judge_error(baseline, found, name.rsplit(", ", 1)[1])
    if area == "speed":
        return judge_ratio(baseline, found)
    return judge_exact(baseline, found)


def compare_records(area, name, baseline, found, known_machine):
    """Outcomes of the figures of one record; either of two dicts may be None."""
    outcomes = []
    for figure in dict.fromkeys([*(baseline or {}), *(found or {})]):
        if figure.startswith("trend"):
            continue
        old, new = (baseline or {}).get(figure), (found or {}).get(figure)
        promise = None if new is None else judge_promise(figure, new)
        if promise:
            verdict, reason = promise
        elif old is None and area in OF_MACHINE and not known_machine:
            verdict, reason = UNGATED, "the baseline does not know this machine"
        elif old is None:
            verdict, reason = NEW, "not in the baseline: accept it"
        elif new is None and (found or {}).get("status") == "failed":
            continue  # its status says so
        elif new is None:
            verdict, reason = VANISHED, "was in the baseline"
        else:
            verdict, reason = judge(area, name, figure, old, new)
            if verdict == WORSE and not known_machine:
                reason += "; accepted on another machine"
        outcomes.append(Outcome(area, name, figure, verdict, old, new, reason))
    return outcomes


def compare(baseline, run, areas):
    """Outcomes of all figures of `areas`, regressions first. A Baseline and a Run."""
    outcomes = []
    for area in areas:
        known = baseline.knows(area, run.machine)
        old = baseline.of(area, run.machine)
        new = {record.name: record.figures for record in run.records if record.area == area}
        for name in dict.fromkeys([*old, *new]):
            outcomes += compare_records(area, name, old.get(name), new.get(name), known)
    return sorted(outcomes, key=lambda outcome: not outcome.fails)


def undecided(outcomes):
    """Whether more processes could change a verdict on speed."""
    return any(o.area == "speed" and o.verdict in (NOISY, WORSE) for o in outcomes)
