"""Kappa curves: how the error depends on the hourglass stiffness."""

import numpy as np

from sandglass_report import axes as helpers
from sandglass_report import style
from sandglass_report.verdicts import REFERENCES
from sandglass_report.plates import Panel

FIGURES = (("max", "-", 1.6), ("profile", "--", 1.3), ("rms", ":", 1.6))
NAMES = {"max": "max, all nodes", "profile": "max, profile", "rms": "rms"}


def kappa_panels(subject, palette):
    """Two panels of a case with kappa curves: error to the golden and to the truth."""
    if not _curves(subject, "golden") and not _curves(subject, "truth"):
        return ()
    limits = _limits(subject)
    return tuple(_panel(subject, palette, kind, limits) for kind in REFERENCES)


def _curves(subject, reference):
    """method -> runs in order of kappa, for the methods with at least two points.

    A curve that coincides with an earlier one (the same formulas computed differently) is omitted.
    """
    curves = {}
    for run in subject.runs:
        if run.kappa is not None and getattr(run, reference) is not None:
            curves.setdefault(run.method, []).append(run)
    different = {}
    for method, runs in curves.items():
        runs.sort(key=lambda run: run.kappa)
        heights = [getattr(run, reference).max for run in runs]
        known = [[getattr(run, reference).max for run in other] for other in different.values()]
        same = any(len(k) == len(heights) and np.allclose(k, heights, 1e-4) for k in known)
        if len(runs) > 1 and not same:
            different[method] = runs
    return different


def _levels(subject):
    """The golden's distances from the truth, by figure."""
    own = subject.golden_to_truth()
    return {} if own is None else {name: getattr(own, name) for name, _, _ in FIGURES}


def _limits(subject):
    values = [v for v in _levels(subject).values() if v]
    for kind in REFERENCES:
        for runs in _curves(subject, kind).values():
            values += [getattr(getattr(r, kind), name) or 0 for r in runs for name, _, _ in FIGURES]
    shown = [value for value in values if value > style.FLOOR] or [style.FLOOR, 1.0]
    return min(shown) / 1.5, max(shown) * 1.5


def _panel(subject, palette, reference, limits):
    curves = _curves(subject, reference)
    levels = _levels(subject)

    def draw(axes):
        kappas = [run.kappa for runs in curves.values() for run in runs]
        helpers.log_scale(axes.xaxis, (min(kappas) / 1.12, max(kappas) * 1.12))
        helpers.percent_scale(axes.yaxis, limits)
        axes.set_xlabel("κ")
        for number, (method, runs) in enumerate(curves.items()):
            # Strokes mean the same figure for all methods, so they are named for one only.
            _draw_curve(axes, method, runs, palette, reference, named=number == 0)
        _draw_auto(axes, curves, palette)
        for name, dashes, _ in FIGURES:  # smaller errors to the golden bring no gain
            if levels.get(name):
                label = "golden to truth, max" if name == "max" else None
                strokes = {"color": style.GOLDEN[0], "linestyle": dashes, "linewidth": 1.3}
                axes.axhline(levels[name], label=label, **strokes)
        axes.legend(frameon=False, fontsize=7.5)

    name = f"kappa.{subject.name}.{reference}"
    alt = f"{subject.name}: error to the {reference} against kappa. " + _in_words(curves, reference)
    missing = "" if curves else style.why_empty(subject, reference)
    return Panel(name, f"error to the {reference}", alt, draw, 410, 300, missing)


def _draw_curve(axes, method, runs, palette, reference, named):
    """The three curves of a method."""
    colour = palette.colour(method)
    for name, dashes, width in FIGURES:
        points = [(r, getattr(getattr(r, reference), name)) for r in runs]
        points = [(r, max(e, style.FLOOR)) for r, e in points if e is not None]
        if points:
            xs, ys = zip(*((run.kappa, error) for run, error in points))
            label = NAMES[name] if named else None
            axes.plot(xs, ys, dashes, color=colour, linewidth=width, label=label)
        for x, y in [(r.kappa, e) for r, e in points if r.kappa_is_auto]:
            axes.plot(x, y, palette.mark(method), color=colour, markersize=5)


def _draw_auto(axes, curves, palette):
    """A line at the value of kappa auto, which depends only on the material."""
    for method, runs in list(curves.items())[:1]:
        for run in runs:
            if run.kappa_is_auto:
                axes.axvline(run.kappa, color=palette.colour(method), linewidth=0.8, alpha=0.5)
                place, data = (run.kappa, 1.0), ("data", "axes fraction")
                strokes = {"va": "top", "color": palette.colour(method)}
                helpers.note(axes, f"auto {run.kappa:.2g}", place, (4, -2), data, **strokes)


def _in_words(curves, reference):
    parts = []
    for method, runs in curves.items():
        best = min(runs, key=lambda run: getattr(run, reference).max)
        error = style.percent(getattr(best, reference).max)
        parts.append(f"{method}: smallest largest error {error} at kappa {best.kappa:g}")
    return "; ".join(parts) or "No figures."
