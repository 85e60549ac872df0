"""The chart of error against cost, with one point per method and kappa."""

import math
from dataclasses import replace

import numpy as np

from sandglass_report import axes as helpers
from sandglass_report import style
from sandglass_report.verdicts import REFERENCES
from sandglass_report.plates import Panel, Plate

FIGURES = (("max", "max over all nodes"), ("rms", "rms over all nodes"))
MOST_LABELS = 4  # more names than these do not fit at their points


def speed_panels(subject, palette, costs):
    """Four panels of a case: max and rms error, to golden and truth, with the same scales."""
    limits = error_limits(subject)
    return tuple(
        _panel(subject, palette, reference, figure, words, limits, costs)
        for figure, words in FIGURES
        for reference in REFERENCES
    )


def speed_plate(subjects, palette, costs):
    """All cases against the golden in one static figure, readable in a README."""
    panels = [
        replace(
            _panel(subject, palette, "golden", "max", "max over all nodes", limits, costs),
            title=subject.name,
            width=290,
            height=260,
        )
        for subject in subjects
        for limits in [error_limits(subject)]
    ]
    return Plate(
        "speed-accuracy",
        "Speed and accuracy of every method: lower left is better",
        tuple(panels),
        min(3, len(subjects)),
        note="Error: largest distance of any node from the golden, the mixed element on the same "
        "mesh, in % of the imposed displacement. "
        "Large marks: methods with default settings; small ones: other values of kappa; bar: "
        "middle half of the timings. Triangle: below the scale.",
        legend=tuple((m, palette.colour(m), palette.mark(m)) for m in palette.methods),
    )


def cost_limits(runs):
    """Common limits of the cost axis, ns per element and step, with room for the labels."""
    costs = [run.ns_per_element_step for run in runs if run.ns_per_element_step > 0]
    return (min(costs) * 0.7, max(costs) * 1.45) if costs else (10.0, 1000.0)


def error_limits(subject):
    """Common limits of a case's error axes, fractions; errors below FLOOR are ignored."""
    errors = [
        getattr(accuracy, figure)
        for run in subject.runs
        for accuracy in (run.golden, run.truth)
        if accuracy is not None
        for figure, _ in FIGURES
    ]
    shown = [error for error in errors if error > style.FLOOR]
    if not shown:
        return style.FLOOR, 1.0
    hidden = len(shown) < len(errors)
    return min(shown) / (4.0 if hidden else 1.6), max(shown) * 1.6


def _panel(subject, palette, reference, figure, words, limits, costs):
    found = [run for run in subject.runs if getattr(run, reference) is not None]

    def draw(axes):
        helpers.log_scale(axes.xaxis, costs)
        helpers.percent_scale(axes.yaxis, limits)
        axes.set_xlabel("ns per element and step")
        axes.figure.canvas.draw()  # the layout must be final before labels are pushed apart
        labels = []  # x, y, colour, text, and the part of it that is kept if names do not fit
        for method in dict.fromkeys(run.method for run in found):
            of_method = [run for run in found if run.method == method]
            labels += _draw_method(axes, of_method, palette, reference, figure, limits)
        crowded = len(labels) > MOST_LABELS
        texts = [(x, y, short if crowded else text, c) for x, y, c, text, short in labels]
        helpers.label_points(axes, [one for one in texts if one[2]][:MOST_LABELS])
        _name_missing(axes, subject, reference)

    return Panel(
        f"speed-accuracy.{subject.name}.{reference}.{figure}",
        f"to the {reference}, {words}",
        f"{subject.name}: {words} of the error to the {reference} against ns per element and step. "
        + _in_words(found, reference, figure),
        draw,
        290,
        250,
        "" if found else style.why_empty(subject, reference),
    )


def _draw_method(axes, runs, palette, reference, figure, limits):
    """Points of one method, its kappa curve as a line; returns the main points' labels."""
    colour, mark = palette.colour(runs[0].method), palette.mark(runs[0].method)
    lowest = limits[0] * 1.5
    # Kappa does not affect the work of a step, so all runs time the same work. The points are at
    # the median of these times, and a bar at the main one shows their middle half.
    times = [run.ns_per_element_step for run in runs]
    early, x, late = np.quantile(times, (0.25, 0.5, 0.75))
    height = {id(run): max(getattr(getattr(run, reference), figure), lowest) for run in runs}
    if len(runs) > 1:
        ys = sorted(height.values())
        axes.plot([x, x], [ys[0], ys[-1]], color=colour, linewidth=0.8, alpha=0.4)
        axes.plot([x] * len(ys), ys, color=colour, marker=mark, linestyle="", markersize=2.6)
    labels = []
    for run in (run for run in runs if run.is_main):
        y = height[id(run)]
        axes.plot([early, late], [y, y], color=colour, linewidth=1.6, alpha=0.45)
        error = getattr(getattr(run, reference), figure)
        hidden = error < lowest
        value = style.percent(error, 1) if hidden else ""
        text = f"{run.method} {value}".rstrip()
        failed = f"{text} (failed)"
        axes.plot(
            x,
            y,
            marker="v" if hidden else mark,
            markersize=7,
            color=colour,
            markeredgecolor=style.PANEL[0] if run.ok else style.BAD[0],
            markeredgewidth=0.8 if run.ok else 1.6,
            linestyle="",
            zorder=4,
        )
        labels.append((late, y, colour, *((text, value) if run.ok else (failed, failed))))
    return labels


def _name_missing(axes, subject, reference):
    """Lists the methods whose main run has no figure, so that their absence is visible."""
    missing = [r.method for r in subject.runs if r.is_main and getattr(r, reference) is None]
    if missing:
        words = "failed: " + ", ".join(missing)
        axes.text(
            1.0,
            1.02,
            words,
            transform=axes.transAxes,
            ha="right",
            va="bottom",
            color=style.BAD[0],
            fontsize=6.8,
        )


def _in_words(runs, reference, figure):
    """The main points as a sentence, for readers who cannot see the picture."""
    parts = []
    for run in (run for run in runs if run.is_main):
        error = style.percent(getattr(getattr(run, reference), figure))
        cost = run.ns_per_element_step
        parts.append(f"{run.method}: {error} at {cost:.0f} ns" if math.isfinite(cost) else "")
    return "; ".join(parts) or "No figures."
