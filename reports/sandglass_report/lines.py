"""The paper's figures 2 and 4: the deformed profile line, and the error along it."""

from dataclasses import dataclass

import numpy as np

from common.accuracy import relative_distances
from sandglass_report import axes as helpers
from sandglass_report import paper, style
from sandglass_report.accuracy import is_closed
from sandglass_report.plates import Panel, Plate


@dataclass(frozen=True)
class Line:
    """One answer along the profile line: name, displacements (n, 3) of all nodes in m, strokes."""

    name: str
    u: np.ndarray
    strokes: dict


def line_plate(subject, experiment, palette):
    """The paper's line figure of a case as a plate of three panels, or None without a profile."""
    if subject.profile() is None:
        return None
    lines = _lines(subject, palette)
    number = experiment.line_figure
    name = f"figure-{number}"
    panels = [_shape_panel(f"{name}.line", subject, lines)]
    for reference in ("golden", "truth"):
        panels.append(_error_panel(f"{name}.{reference}", subject, lines, reference))
    title = f"Figure {number}. {experiment.title}: the line of nodes in y = 0"
    return Plate(name, title, tuple(panels), 3)


def _lines(subject, palette):
    """Truth, golden, and the main runs of the methods compared in the paper's figure."""
    lines = []
    if subject.golden is not None:
        strokes = {"color": style.GOLDEN[0], "linewidth": 4.5, "alpha": 0.75, "zorder": 2}
        lines.append(Line("golden", subject.golden.displacement, strokes))
    if subject.truth is not None:
        strokes = {"color": style.INK[0], "linewidth": 1.2, "linestyle": (0, (4, 2)), "zorder": 5}
        lines.append(Line("truth", subject.truth.displacement, strokes))
    for method in paper.LINE_METHODS:
        u = subject.displacement(method)
        if u is None:
            continue
        ours = method == paper.METHOD
        strokes = {"color": palette.colour(method), "linewidth": 1.2, "zorder": 4 if ours else 3}
        if ours:
            strokes |= {"linestyle": "", "marker": "o", "markersize": 3.2}
        if method == paper.WITHOUT_CONTROL:
            strokes |= {"linewidth": 0.8, "zorder": 1, "alpha": 0.75}
        lines.append(Line(method, u, strokes))
    return lines


def _shape_panel(name, subject, lines):
    """The deformed line in its own plane, with all answers overlaid."""
    nodes, _ = subject.profile()
    rest = subject.points[nodes]
    across, up = _plane(rest, subject, nodes)
    closed = is_closed(subject.profile_order)

    def draw(axes):
        axes.set_aspect("equal", adjustable="datalim")
        axes.plot(*_path(rest, across, up, closed), color=style.MUTED[0], linewidth=0.8, ls=":")
        known = [rest]
        for line in lines:
            points = rest + line.u[nodes]
            if _is_golden(line, subject):
                continue
            axes.plot(*_path(points, across, up, closed), **line.strokes, label=line.name)
            if line.name in ("golden", "truth", paper.METHOD):
                known.append(points)
        # A failing method may be far off; the sound answers set the scale.
        seen = np.vstack(known)[:, [across, up]]
        low, high = seen.min(axis=0), seen.max(axis=0)
        pad = 0.06 * (high - low).max()
        axes.set_xlim(low[0] - pad, high[0] + pad)
        axes.set_ylim(low[1] - pad, high[1] + pad)
        axes.set_xlabel(f"{'xyz'[across]}, m")
        axes.set_ylabel(f"{'xyz'[up]}, m")
        place = {"loc": "lower center", "ncol": 2} if closed else {"loc": "lower right"}
        axes.legend(**place, frameon=False, handlelength=1.8)

    names = ", ".join(line.name for line in lines)
    alt = f"{subject.name}: the deformed profile line of {names}."
    return Panel(name, "deformed line (dotted: undeformed)", alt, draw, 400, 380)


def _error_panel(name, subject, lines, reference):
    """Distance of every answer from a reference along the line, in % of the imposed one."""
    stored = getattr(subject, reference)
    nodes, along = subject.profile()
    angle = is_closed(subject.profile_order)

    def draw(axes):
        curves, nil = [], []
        for line in lines:
            if line.name == reference or reference == "truth" and _is_golden(line, subject):
                continue
            errors = relative_distances(line.u, stored.displacement, subject.unit_of(stored))[nodes]
            (curves if errors.max() > style.FLOOR else nil).append((line, errors))
        peak = max((errors.max() for _, errors in curves), default=1.0)
        seen = [error for _, errors in curves for error in errors if error > style.FLOOR]
        least = min(seen, default=style.FLOOR)
        helpers.percent_scale(axes.yaxis, (least / (6 if nil else 2), peak * 3))
        for line, errors in curves:
            strokes = line.strokes | {"linestyle": line.strokes.get("linestyle") or "-"}
            strokes |= {"linewidth": min(line.strokes["linewidth"], 2.2), "marker": ""}
            axes.plot(along, np.where(errors > style.FLOOR / 10, errors, np.nan), **strokes)
        axes.set_xlim(along.min(), along.max())
        _shade_imposed(axes, subject, nodes, along)
        if angle:
            axes.set_xticks(range(-180, 181, 90))
            axes.set_xlabel(f"angle {subject.profile_order.replace('-', ' ')}, degrees (0: top)")
        else:
            axes.set_xlabel(f"undeformed {subject.profile_order}, m")
        for i, (line, errors) in enumerate(nil):
            axes.text(
                0.02,
                0.02 + 0.06 * i,
                f"{line.name}: at most {style.percent(errors.max(), 2)}",
                transform=axes.transAxes,
                fontsize=7.5,
                color=line.strokes["color"],
            )

    alt = f"{subject.name}: distance from the {reference} along the profile line."
    missing = "" if stored is not None else style.why_empty(subject, reference)
    return Panel(name, f"distance from the {reference} along it", alt, draw, 400, 380, missing)


def _is_golden(line, subject):
    """Whether another answer looks the same as the golden."""
    if line.name in ("golden", "truth") or subject.golden is None:
        return False
    distances = relative_distances(
        line.u, subject.golden.displacement, subject.unit_of(subject.golden)
    )
    return distances.max() < style.FLOOR


def _shade_imposed(axes, subject, nodes, along):
    """Shades the parts of the line whose nodes are held or driven, where the error is zero."""
    for name, value in subject.imposed:
        inside = np.isin(nodes, subject.sets.get(name, ()))
        # Runs of consecutive nodes inside, as (first, last) indices.
        edges = np.flatnonzero(np.diff(np.concatenate([[0], inside.astype(int), [0]])))
        spans = [(first, last - 1) for first, last in edges.reshape(-1, 2)]
        for first, last in spans:
            axes.axvspan(along[first], along[last], color=style.GRID[0], alpha=0.6, linewidth=0)
        first, last = max(spans, key=lambda span: span[1] - span[0], default=(0, 0))
        if last > first:
            text, middle = "driven" if np.any(value) else "held", (along[first] + along[last]) / 2
            strokes = {"ha": "center", "va": "top", "color": style.MUTED[0]}
            data = "data", "axes fraction"
            helpers.note(axes, text, (middle, 0.985), (0, 0), data, **strokes)


def _plane(rest, subject, nodes):
    """The two axes (across, up) of the picture: those in which the line extends or moves most."""
    moved = rest if subject.golden is None else rest + subject.golden.displacement[nodes]
    extent = np.ptp(np.vstack([rest, moved]), axis=0)
    thin = int(np.argmin(extent))
    across, up = (i for i in range(3) if i != thin)
    return across, up


def _path(points, across, up, closed):
    """Coordinates to draw; the first node is repeated at the end of a closed line."""
    if closed:
        points = np.vstack([points, points[:1]])
    return points[:, across], points[:, up]
