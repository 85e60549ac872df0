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
        low, high = min(kappas), max(kappas)
        helpers.log_scale(axes.xaxis, (low / 1.12, high * (high / low) ** 0.3), last_tick=high)
        helpers.percent_scale(axes.yaxis, limits)
        axes.set_xlabel("κ")
        axes.figure.canvas.draw()
        # Strokes mean the same figure for all methods, so the ends are named for one only.
        labels = [_draw_curve(axes, m, r, palette, reference) for m, r in curves.items()]
        _draw_auto(axes, curves, palette)
        _label_ends(axes, [(*end[:3], style.INK[0]) for end in labels[0]])
        _draw_levels(axes, levels, curves, reference)

    name = f"kappa.{subject.name}.{reference}"
    alt = f"{subject.name}: error to the {reference} against kappa. " + _in_words(curves, reference)
    missing = "" if curves else style.why_empty(subject, reference)
    return Panel(name, f"error to the {reference}", alt, draw, 410, 300, missing)


def _draw_curve(axes, method, runs, palette, reference):
    """The three curves of a method; returns the labels of their ends."""
    labels = []
    for name, dashes, width in reversed(FIGURES):  # the last label is drawn on top
        points = [(r.kappa, getattr(getattr(r, reference), name)) for r in runs]
        points = [(k, max(e, style.FLOOR)) for k, e in points if e is not None]
        if not points:
            continue
        xs, ys = zip(*points)
        colour = palette.colour(method)
        axes.plot(xs, ys, dashes, color=colour, linewidth=width)
        marked = [(r.kappa, getattr(getattr(r, reference), name)) for r in runs if r.kappa_is_auto]
        for x, y in marked:
            axes.plot(x, max(y, style.FLOOR), palette.mark(method), color=colour, markersize=5)
        labels.append((xs[-1], ys[-1], NAMES[name], colour))
    return labels


def _draw_auto(axes, curves, palette):
    """A line at the value of kappa auto, which depends only on the material."""
    for method, runs in list(curves.items())[:1]:
        for run in runs:
            if run.kappa_is_auto:
                axes.axvline(run.kappa, color=palette.colour(method), linewidth=0.8, alpha=0.5)
                place, data = (run.kappa, 1.0), ("data", "axes fraction")
                strokes = {"va": "top", "color": palette.colour(method)}
                helpers.note(axes, f"auto {run.kappa:.2g}", place, (4, -2), data, **strokes)


def _label_ends(axes, labels):
    """Names of the curves at their right ends."""
    pixels_per_point = axes.figure.dpi / 72
    box = axes.get_window_extent()
    gap = 10.5 * pixels_per_point
    heights = [axes.transData.transform(label[:2])[1] for label in labels]
    moved = helpers.spread(heights, gap, box.y0 + gap / 2, box.y1 - gap / 2)
    for (x, y, text, colour), old, new in zip(labels, heights, moved):
        up = (new - old) / pixels_per_point
        helpers.note(axes, text, (x, y), (5, up), va="center", color=colour)


def _draw_levels(axes, levels, curves, reference):
    """The golden's distance from the truth: below it, a smaller error to the golden is no gain."""
    for name, dashes, _ in FIGURES:
        if levels.get(name):
            axes.axhline(levels[name], color=style.GOLDEN[0], linestyle=dashes, linewidth=1.3)
    if levels.get("max"):
        place, above = _free_place(axes, levels, curves, reference)
        side, up = ("bottom", 3) if above else ("top", -3)
        strokes = {"ha": "center", "va": side, "color": style.GOLDEN[0]}
        at, data = (place, levels["max"]), ("axes fraction", "data")
        helpers.note(axes, "golden to truth, max", at, (0, up), data, **strokes)


def _free_place(axes, levels, curves, reference):
    """The place for a label at the max level with most space: (fraction across, whether above)."""
    box = axes.get_window_extent()
    to_pixels = axes.transData.transform
    level = to_pixels((axes.get_xlim()[0], levels["max"]))[1]
    others = [value for name, value in levels.items() if name != "max" and value]
    lines = [to_pixels([(x, value) for x in axes.get_xlim()]) for value in others]
    for runs in curves.values():
        for name, _, _ in FIGURES:
            points = [(r.kappa, getattr(getattr(r, reference), name)) for r in runs]
            lines += [to_pixels(found) for found in [[p for p in points if p[1]]] if found]

    def clearance(place, above):
        height = level + (1 if above else -1) * 0.03 * box.height
        across = box.x0 + box.width * np.linspace(place - 0.16, place + 0.16, 9)
        gaps = [np.abs(np.interp(across, *line.T) - height).min() for line in lines]
        return min(gaps)

    places = [(place, above) for above in (True, False) for place in (0.18, 0.35, 0.5, 0.65)]
    return max(places, key=lambda place: clearance(*place))


def _in_words(curves, reference):
    parts = []
    for method, runs in curves.items():
        best = min(runs, key=lambda run: getattr(run, reference).max)
        error = style.percent(getattr(best, reference).max)
        parts.append(f"{method}: smallest largest error {error} at kappa {best.kappa:g}")
    return "; ".join(parts) or "No figures."
