"""The findings of the runs in words: captions of cases, and one line about all failures.

Everything here is made from the verdicts, so that captions and tables agree.
"""

from dataclasses import dataclass

from sandglass_report import style

# Finding of a run -> what the method does, as the verb of a sentence.
VERBS = {
    "good": "is good",
    "not judged": "is not judged",
    "inaccurate": "is inaccurate",
    "hourglassing": "hourglasses",
    "locking": "locks",
    "inverted": "turns elements inside out",
    "unstable": "is unstable",
    "not at rest": "finds no equilibrium",
    "not supported": "does not support this case",
}
NOT_SUPPORTED = "not supported"  # in place of a finding
USUAL_LIMIT = 0.01  # of good_limit in suite/comparison/finding.cpp
LARGEST_GOOD = 0.1  # largest_good_limit of suite/comparison/finding.hpp


def caption(subject, method, limits):
    """The sentences about a case: one method's finding, all methods' findings, and its limits.

    limits: all limits of the verdicts.
    """
    found = [_of_method(subject, method), _of_kappas(subject, method)]
    own = subject.golden_to_truth()
    if own is not None and own.max > LARGEST_GOOD:
        found.append(
            f"The golden is {style.percent(own.max, 2)} from the truth: no verdict on runs that "
            f"are more than {style.exact_percent(LARGEST_GOOD)} from the golden but closer to it "
            "than the truth is."
        )
    found += [_of_all(subject), _of_limits([one for one in limits if one.case == subject.name])]
    return tuple(filter(None, found))


def verb(finding):
    """The verb for a finding, such as "locks"."""
    return VERBS.get(finding, f"is found {finding}")


def judged(run):
    """The finding of a run; NOT_SUPPORTED if the method refuses the case, "" without a golden."""
    return run.finding or ("" if run.ok else NOT_SUPPORTED)


def _of_method(subject, method):
    """The sentence about one method with its default settings."""
    run = subject.main_run(method)
    if run is None:
        return f"{method} was not run."
    if not run.ok:
        return f"{method} {verb(judged(run))}: {run.status.removeprefix('failed: ')}."
    if run.golden is None or not run.finding:
        return f"{method} cannot be judged, as there is no golden."
    words = f"{method} {verb(run.finding)}{_why_good(subject, run)}: "
    words += f"{style.percent(run.golden.max)} from the golden at the worst node"
    words += " and time" if subject.motion is not None else ""
    if run.golden.profile is not None:
        words += f", {style.percent(run.golden.profile)} on the profile line"
    return words + "."


def _why_good(subject, run):
    """Why a run beyond the usual limit is still good: the golden has an error, too."""
    own = subject.golden_to_truth()
    if run.finding != "good" or run.golden.max <= USUAL_LIMIT or own is None:
        return ""
    return f", given the golden’s own error of {style.percent(own.max, 2)}"


def _of_kappas(subject, method):
    """The sentence about the kappa with the smallest error, where another one is better."""
    run = subject.main_run(method)
    curve = [r for r in subject.runs if r.method == method and r.ok and r.golden is not None]
    if run is None or not run.ok or run.golden is None or not curve:
        return ""
    best = min(curve, key=lambda r: r.golden.max)
    if best.is_main or best.golden.max > 0.99 * run.golden.max:
        return ""
    return (
        f"The best of {len(curve)} kappas, {best.kappa:g}, gives {style.percent(best.golden.max)}."
    )


def _of_all(subject):
    """The number of methods with each finding."""
    words = [judged(run) for run in subject.runs if run.is_main and judged(run)]
    if not words:
        return ""
    kinds = sorted(set(words), key=[*VERBS, *words].index)
    counts = ", ".join(f"{words.count(kind)} {kind}" for kind in kinds)
    return f"All {len(words)} methods: {counts}."


def _of_limits(limits):
    """How many of the limits of a case hold."""
    holding = sum(limit.holds for limit in limits)
    if holding < len(limits):
        return f"{len(limits) - holding} of the case’s {len(limits)} limits BROKEN."
    return f"The case’s {len(limits)} limits hold." if len(limits) > 1 else ""


@dataclass(frozen=True)
class Failures:
    """The runs with default settings that end without an answer."""

    expected: tuple  # of methods that a limit requires to fail, on this case or another
    unexpected: tuple
    not_taken: tuple  # of methods that do not support the case
    total: int  # runs with default settings, these included

    @property
    def count(self):
        """The number of failed runs; unsupported cases do not count."""
        return len(self.expected) + len(self.unexpected)

    def sentences(self):
        """All failures in a few sentences; unexpected ones with their reasons."""
        found = []
        if self.count:
            found.append(f"{self.count} of {self.total} runs with default settings fail")
            found[0] += "." if self.unexpected else ", as expected."
        if self.expected:
            found.append(f"These failures are required by cases: {_on_cases(self.expected)}.")
        for run in self.unexpected:
            why = run.status.removeprefix("failed: ")
            found.append(f"Not expected: {run.method} on {run.case} ({why}).")
        if self.not_taken:
            found.append(f"Cases that a method does not support: {_on_cases(self.not_taken)}.")
        return tuple(found)


def failures(verdicts):
    """The Failures of the verdicts.

    A failure is expected if some case requires the method's error to exceed a limit: such a
    method is in the suite to fail.
    """
    meant = {limit.method for limit in verdicts.limits if limit.above is not None}
    main = [run for run in verdicts.runs if run.is_main]
    failed = [run for run in main if not run.ok and run.finding]
    return Failures(
        tuple(run for run in failed if run.method in meant),
        tuple(run for run in failed if run.method not in meant),
        tuple(run for run in main if not run.ok and not run.finding),
        len(main),
    )


def _on_cases(runs):
    """The methods of runs with their cases: the names of up to two, else their number."""
    cases = {}
    for run in runs:
        cases.setdefault(run.method, []).append(run.case)
    few = {m: " and ".join(c) if len(c) < 3 else f"{len(c)} cases" for m, c in cases.items()}
    return "; ".join(f"{method} on {where}" for method, where in few.items())
