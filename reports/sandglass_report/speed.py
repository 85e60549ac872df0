"""The static chart of error against cost of a case, with one point per method and kappa."""

from sandglass_report import axes as helpers
from sandglass_report import style
from sandglass_report.plates import Panel
from sandglass_report.quantities import QUANTITIES
from sandglass_report.verdicts import REFERENCES

FIGURES = ("max", "rms")
COST = QUANTITIES["simulated"]
UNTIMED = "no run has a time per simulated second"
MOST_LABELS = 4  # more names than these do not fit at their points


def speed_panels(subject, palette):
    """Four panels of a case: max and rms error, to golden and truth, with the same scales."""
    limits, costs = error_limits(subject), cost_limits(subject.runs)
    return tuple(
        _panel(subject, palette, reference, figure, limits, costs)
        for figure in FIGURES
        for reference in REFERENCES
    )


def cost_limits(runs):
    """Limits of the cost axis, s of wall time per simulated second, with room for the labels."""
    costs = [run.simulated for run in runs if run.simulated]
    return (min(costs) * 0.7, max(costs) * 1.45) if costs else (0.1, 10.0)


def error_limits(subject):
    """Common limits of a case's error axes, fractions; errors below FLOOR are ignored."""
    errors = [
        getattr(accuracy, figure)
        for run in subject.runs
        for accuracy in (run.golden, run.truth)
        if accuracy is not None
        for figure in FIGURES
    ]
    shown = [error for error in errors if error > style.FLOOR]
    if not shown:
        return style.FLOOR, 1.0
    hidden = len(shown) < len(errors)
    return min(shown) / (4.0 if hidden else 1.6), max(shown) * 1.6


def _panel(subject, palette, reference, figure, limits, costs):
    found = [run for run in subject.runs if getattr(run, reference) is not None]
    timed = [run for run in found if run.simulated]
    words = QUANTITIES[figure].name

    def draw(axes):
        helpers.log_scale(axes.xaxis, costs)
        helpers.percent_scale(axes.yaxis, limits)
        axes.set_xlabel(COST.title)
        axes.figure.canvas.draw()  # the layout must be final before labels are pushed apart
        labels = []  # x, y, colour, text, and the part of it to keep if names do not fit
        for method in dict.fromkeys(run.method for run in timed):
            of_method = [run for run in timed if run.method == method]
            labels += _draw_method(axes, of_method, palette, reference, figure, limits)
        crowded = len(labels) > MOST_LABELS
        texts = [(x, y, short if crowded else text, c) for x, y, c, text, short in labels]
        helpers.label_points(axes, [one for one in texts if one[2]][:MOST_LABELS])
        _name_missing(axes, subject, reference, len(found) - len(timed))

    missing = style.why_empty(subject, reference) if not found else "" if timed else UNTIMED
    return Panel(
        f"speed-accuracy.{subject.name}.{reference}.{figure}",
        f"to the {reference}, {QUANTITIES[figure].head}",
        f"{subject.name}: {words}, to the {reference}, against {COST.title}. "
        + _in_words(timed, reference, figure),
        draw,
        290,
        250,
        missing,
    )


def _draw_method(axes, runs, palette, reference, figure, limits):
    """Points of one method, its kappa curve as a line; returns the main points' labels."""
    colour, mark = palette.colour(runs[0].method), palette.mark(runs[0].method)
    lowest = limits[0] * 1.5
    height = {id(run): max(getattr(getattr(run, reference), figure), lowest) for run in runs}
    if len(runs) > 1:
        xs, ys = zip(*sorted((run.simulated, height[id(run)]) for run in runs))
        axes.plot(xs, ys, color=colour, linewidth=0.8, alpha=0.4)
        axes.plot(xs, ys, color=colour, marker=mark, linestyle="", markersize=2.6)
    labels = []
    for run in (run for run in runs if run.is_main):
        x, y = run.simulated, height[id(run)]
        early, late = middle_half(run)
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


def middle_half(run):
    """The quartiles of a run's cost: those of its step, at its mean step; the cost if unknown."""
    if not run.ns or run.ns_low is None or run.ns_high is None:
        return run.simulated, run.simulated
    checks = run.check_ns or 0.0
    return tuple(
        run.simulated * (ns + checks) / (run.ns + checks) for ns in (run.ns_low, run.ns_high)
    )


def _name_missing(axes, subject, reference, untimed):
    """Lists the methods whose main run has no figure, so that their absence is visible.

    untimed: the number of runs with a figure but without a time.
    """
    missing = [r.method for r in subject.runs if r.is_main and getattr(r, reference) is None]
    remarks = ["failed: " + ", ".join(missing)] if missing else []
    remarks += [f"{untimed} not timed"] if untimed else []
    if remarks:
        words = "; ".join(remarks)
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
        parts.append(f"{run.method}: {error} at {run.simulated:.3g} {COST.unit}")
    return "; ".join(parts) or "No figures."
