"""Axes of charts: percent scales, labels that do not overlap."""

import math

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

TICKS_1_2_5 = (1, 2, 5)


def percent_scale(axis, limits):
    """Makes an axis logarithmic over fractions, with ticks like 0.1 % at every decade."""
    axis.axes.set_yscale("log") if axis.axis_name == "y" else axis.axes.set_xscale("log")
    axis.axes.set_ylim(limits) if axis.axis_name == "y" else axis.axes.set_xlim(limits)
    narrow = math.log10(limits[1] / limits[0]) < 2.6
    axis.set_major_locator(LogLocator(subs=TICKS_1_2_5 if narrow else (1,), numticks=20))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:.10g} %"))


def log_scale(axis, limits):
    """Makes an x axis logarithmic with plain numbers as ticks."""
    axis.axes.set_xscale("log")
    axis.axes.set_xlim(limits)
    wide = limits[1] > 400 * limits[0]
    axis.set_major_locator(LogLocator(subs=(1,) if wide else TICKS_1_2_5, numticks=20))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.10g}"))


def spread(positions, gap, low, high):
    """Positions moved as little as needed to lie `gap` apart, kept in order, within low..high."""
    order = np.argsort(positions, kind="stable")
    moved = np.asarray(positions, dtype=float)[order]
    for _ in range(200):
        overlap = gap - np.diff(moved)
        if (overlap <= 1e-6).all():
            break
        for i in np.flatnonzero(overlap > 1e-6):
            shift = (gap - (moved[i + 1] - moved[i])) / 2
            if shift > 0:
                moved[i] -= shift
                moved[i + 1] += shift
        moved += max(0.0, low - moved[0]) - max(0.0, moved[-1] - high)
    result = np.empty_like(moved)
    result[order] = moved
    return result


def note(axes, text, place, offset, data="data", size=7.5, **strokes):
    """Writes a text beside a place. offset: points. data: coordinates of the place, or two."""
    strokes |= {"xycoords": data, "textcoords": "offset points", "fontsize": size}
    axes.annotate(text, place, xytext=offset, **strokes)


def label_points(axes, labels, size=7.5):
    """Writes labels next to their points, on the side with more space, without overlaps.

    labels: list of (x, y, text, colour) in data coordinates; scales and limits must be set.
    Overlaps between the two sides are also avoided, as they can occur in narrow panels.
    """
    if not labels:
        return
    box = axes.get_window_extent()
    pixels_per_point = axes.figure.dpi / 72
    gap = size * 1.35 * pixels_per_point
    at = axes.transData.transform([(x, y) for x, y, _, _ in labels])
    heights = spread(at[:, 1], gap, box.y0 + gap / 2, box.y1 - gap / 2)
    for (x, y, text, colour), point, height in zip(labels, at, heights):
        on_the_left = point[0] < box.x0 + 0.5 * box.width
        up = (height - point[1]) / pixels_per_point
        # A label that was moved vertically may extend below or above its point.
        aside = 8 if abs(up) < size else 0
        side, aside = ("left", aside) if on_the_left else ("right", -aside)
        strokes = {"ha": side, "va": "center", "color": colour, "fontweight": "bold"}
        note(axes, text, (x, y), (aside, up), size=size, **strokes)
