"""Figures of the solver by area and name, and the rules that compare them with accepted ones.

Figures are a dict: (area, name) -> {figure: number or text}.
"""

from dataclasses import dataclass

from common.errors import InputError
from common.files import read_json
from common.records import entries, entry

AREAS = ("accuracy", "operations")
# A build reproduces its errors exactly; other compilers or instruction sets round differently, and
# relaxation ends elsewhere. README.md has the largest changes of errors seen.
RELATIVE = 1e-3
FLOOR = {"double": 2e-7, "float": 1e-4}  # fractions of the largest imposed displacement

SAME, BETTER, NEW, WORSE, VANISHED = "same", "better", "new", "WORSE", "VANISHED"
FAILING = (WORSE, VANISHED)


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


def _errors(verdict):
    """The errors of a verdict by name: fractions of the largest imposed displacement."""
    figures = {}
    for reference in ("golden", "truth"):
        for key, value in (verdict.get(reference) or {}).items():
            if value is not None:
                figures[f"{reference} {key.removesuffix('_relative_error')}"] = value
    for value in verdict.get("values", []):
        # Rounding decides in which order nodes touch: a force is judged by the limit of its case.
        if value.get("ratio") is not None and value.get("of") != "force":
            figures[f"published {value['set']} {value['component']}"] = abs(value["ratio"] - 1.0)
    return figures


def _entries(path, document, key, required):
    """The objects of a list of a document, each with the required keys and kinds."""
    found = entries(path, document, key)
    for where, one in found:
        for name, kind in required.items():
            entry(where, one, name, kind)
    return [one for _, one in found]


def read_verdicts(path):
    """(figures, document) of `sandglass verify --json`. Raises InputError."""
    document, figures = read_json(path), {}
    required = {"case": str, "method": str, "precision": str, "status": str}
    for key in ("records", "published"):
        for one in _entries(path, document, key, required):
            kappa = one.get("kappa")
            if kappa is not None:
                kappa = "auto" if one.get("kappa_is_auto") else f"{kappa:g}"
            parts = (one["case"], one["method"], kappa and f"kappa {kappa}", one["precision"])
            name = ", ".join(filter(None, parts))
            if ("accuracy", name) in figures:
                raise InputError(f"{path}: accuracy: '{name}' is there twice; once is allowed")
            # The point where a failed run stopped is arbitrary.
            is_ok = one["status"] == "ok"
            found = {"status": "ok", **_errors(one)} if is_ok else {"status": "failed"}
            figures["accuracy", name] = found
    return figures, document


def read_flops(path):
    """(figures, document) of `sandglass flops --json`. Raises InputError."""
    document, figures = read_json(path), {}
    counts = ("add", "mul", "div", "special", "bytes")
    required = dict.fromkeys(("method", "law", "form", "part"), str) | dict.fromkeys(counts, int)
    for one in _entries(path, document, "records", required):
        name = ", ".join(one[key] for key in ("method", "law", "form", "part"))
        figures["operations", name] = {count: one[count] for count in counts}
    return figures, document


def judge_error(baseline, found, precision):
    """(verdict, reason) of an error: a fraction of the largest imposed displacement."""
    margin = RELATIVE * baseline + FLOOR[precision]
    if abs(found - baseline) <= margin:
        return SAME, ""
    reason = f"{found - baseline:+.2e}; may rise by {margin:.1e}"
    return (WORSE if found > baseline else BETTER), reason


def judge(area, name, figure, baseline, found):
    """(verdict, reason) of a figure present in both."""
    if found == baseline:
        return SAME, ""
    if figure == "status":
        is_worse = found == "failed"
        return (WORSE, "no longer comes to rest") if is_worse else (BETTER, "comes to rest")
    if area == "accuracy":
        return judge_error(baseline, found, name.rsplit(", ", 1)[1])
    return (WORSE if found > baseline else BETTER), f"{found - baseline:+g}; must be equal"


def compare(baseline, found):
    """Outcomes of all figures of two dicts, regressions first."""
    outcomes = []
    for area, name in dict.fromkeys([*baseline, *found]):
        old, new = baseline.get((area, name), {}), found.get((area, name), {})
        for figure in dict.fromkeys([*old, *new]):
            values = old.get(figure), new.get(figure)
            if None not in values:
                verdict = judge(area, name, figure, *values)
            elif values[0] is None:
                verdict = NEW, "not in the baseline: accept it"
            elif new.get("status") == "failed":
                continue  # its status shows that
            else:
                verdict = VANISHED, "was in the baseline"
            outcomes.append(Outcome(area, name, figure, verdict[0], *values, verdict[1]))
    return sorted(outcomes, key=lambda outcome: outcome.verdict not in FAILING)
