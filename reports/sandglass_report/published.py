"""Published benchmarks: ours over mesh and time beside the values of other programs."""

from dataclasses import dataclass

from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from sandglass_report import axes as scales
from sandglass_report import style
from sandglass_report.plates import MUTED, TEXT, Panel, Plate
from sandglass_report.quantities import QUANTITIES

SOUND = 0.05  # of the published value: a method that is farther off on its finest mesh has failed
OTHER = "other"  # in place of the mesh, for values without one


@dataclass(frozen=True)
class Benchmark:
    """A published value of cases on several meshes, with our results and those of others."""

    title: str
    published: float
    source: str
    meshes: tuple  # elements per side, in order; OTHER stands last
    rows: tuple  # (method, {mesh: Tip})
    programs: tuple  # (Program, {mesh: value})
    failed: tuple  # (method, why) of methods that are not sound on their finest mesh
    plate: Plate


def benchmarks(tips, palette):
    """The Benchmarks of all published values for which other programs are listed.

    tips: of the verdicts. Variants must end with the number of elements per side.
    """
    groups = {}
    for tip in tips:
        if tip.programs and palette.knows(tip.method):
            *others, mesh = tip.variant.split()
            title = " ".join([tip.family, *others]) + f": {tip.component} of {tip.set}"
            groups.setdefault(title, {}).setdefault(tip.method, {})[int(mesh)] = tip
    return tuple(_benchmark(title, methods, palette) for title, methods in groups.items())


def _benchmark(title, methods, palette):
    """The Benchmark of {method: {mesh: Tip}}."""
    one = next(iter(next(iter(methods.values())).values()))
    programs = tuple(
        (p, dict(zip(p.elements or [OTHER], p.values, strict=True))) for p in one.programs
    )
    found = {mesh for _, values in (*methods.items(), *programs) for mesh in values}
    meshes = tuple(sorted(found - {OTHER})) + (OTHER,) * (OTHER in found)
    failed = tuple((m, why) for m, row in methods.items() if (why := _why_failed(row)))
    name = "published." + "".join(c if c.isalnum() else "-" for c in title.lower())
    panels = (
        _over_meshes(name, one, methods, programs, palette),
        _over_seconds(name, one, methods, palette),
    )
    legend = tuple((m, palette.colour(m), palette.mark(m)) for m in methods)
    note = (
        f"Published: {one.published:g} ({one.source}). Dotted: other programs. Faint: fails "
        "here; values beyond the edges are arrowheads."
    )
    return Benchmark(
        title,
        one.published,
        one.source,
        meshes,
        tuple(methods.items()),
        programs,
        failed,
        Plate(name, title, panels, 2, note, legend),
    )


def _why_failed(row):
    """Why a method is not sound on its finest mesh; empty if it is."""
    tip = row[max(row)]
    if not tip.ok or tip.to_published is None:
        return "no answer"
    return deviation(tip.to_published) if abs(tip.to_published - 1) > SOUND else ""


def deviation(ratio):
    """The deviation from a published value in words. ratio: the value over the published one."""
    if ratio < 0:
        return "of the wrong sign"
    if ratio > 2:
        return f"{style.plain(ratio, 2)} times the published value"
    off = abs(ratio - 1)
    # Close to 100 % the digits that matter come last: 99.96 %, not 100 %.
    return f"{style.percent(off, 4 if off > 0.99 else 2)} too {'small' if ratio < 1 else 'large'}"


def _answers(row):
    """(mesh, Tip) of the runs that reached equilibrium, coarsest first."""
    return [(mesh, tip) for mesh, tip in sorted(row.items()) if tip.ok and tip.computed is not None]


def _over_meshes(name, one, methods, programs, palette):
    """The value over elements per side, of our methods and of other programs."""
    sign = 1 if one.published > 0 else -1
    top = 1.15 * abs(one.published)
    sound = [
        sign * tip.computed
        for row in methods.values()
        if not _why_failed(row)
        for _, tip in _answers(row)
    ]
    bottom = max(min(sound, default=0) - 0.1 * abs(one.published), 0)

    def draw(axes):
        found = {mesh for _, row in (*methods.items(), *programs) for mesh in row} - {OTHER}
        axes.axhline(abs(one.published), color=MUTED, lw=0.9, ls="--")
        for method, row in methods.items():
            values = [(m, sign * t.computed) for m, t in _answers(row)]
            _line(axes, _clipped(values, bottom, top), method, row, palette)
            _arrowheads(axes, values, bottom, top, palette.colour(method))
        labels = []
        for program, values in programs:
            known = sorted((m, sign * v) for m, v in values.items() if m != OTHER)
            points = _clipped(known, bottom, top)
            _arrowheads(axes, known, bottom, top, TEXT)
            if not points:
                axes.axhline(sign * values[OTHER], color=TEXT, lw=0.7, ls=":")
                points = [(max(found), sign * values[OTHER])]
            axes.plot(*zip(*points), ":x", color=TEXT, lw=1.0, ms=4.5)
            x, y = points[len(points) // 2]
            labels.append((x, y + 0.025 * (top - bottom), program.program, TEXT))
        axes.set_xscale("log", base=2)
        ticks = [2**n for n in range(10) if min(found) <= 2**n <= max(found)]
        axes.xaxis.set_major_locator(FixedLocator(ticks))
        axes.xaxis.set_minor_locator(NullLocator())
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        margin = 0.02 * (top - bottom)
        axes.set_ylim(bottom - margin, top + margin)
        axes.set_xlabel("elements per side")
        axes.set_ylabel(("" if sign > 0 else "−") + f"{one.component} of {one.set}")
        scales.label_points(axes, labels, size=7)

    words = "; ".join(
        f"{method}: " + ", ".join(f"{tip.computed:.4g} at {mesh}" for mesh, tip in _answers(row))
        for method, row in methods.items()
        if _answers(row)
    )
    alt = f"Value over elements per side, published {one.published:g}. {words}"
    return Panel(f"{name}.meshes", "Over elements per side", alt, draw, 420, 340)


def _over_seconds(name, one, methods, palette):
    """The distance from the published value over the seconds to equilibrium."""
    lines = {
        method: [
            (tip.seconds, max(abs(tip.to_published - 1), style.FLOOR))
            for _, tip in _answers(row)
            if tip.seconds
        ]
        for method, row in methods.items()
    }
    points = [point for line in lines.values() for point in line]

    def draw(axes):
        for method, line in lines.items():
            _line(axes, line, method, methods[method], palette)
        seconds, errors = zip(*points)
        scales.log_scale(axes.xaxis, (min(seconds) / 1.5, max(seconds) * 1.5))
        scales.percent_scale(axes.yaxis, (max(min(errors), 1e-4) / 1.5, max(errors) * 1.5))
        axes.set_xlabel(QUANTITIES["equilibrium"].title)
        axes.set_ylabel(QUANTITIES["distance"].name)

    alt = f"Distance from {one.published:g} over {QUANTITIES['equilibrium'].title}"
    missing = "" if points else "no method found equilibrium"
    return Panel(f"{name}.seconds", "Over wall time", alt, draw, 420, 340, missing)


def _line(axes, points, method, row, palette):
    """The line of a method, faint if it is not sound."""
    faint = 0.35 if _why_failed(row) else 1.0
    strokes = {"color": palette.colour(method), "marker": palette.mark(method), "alpha": faint}
    if points:
        axes.plot(*zip(*points), **strokes, lw=1.0, ms=4.5, mew=0)


def _clipped(points, low, high):
    """Points (x, y) with heights beyond an axis moved to its ends."""
    return [(x, min(max(y, low), high)) for x, y in points]


def _arrowheads(axes, points, low, high, colour):
    """Arrowheads at the ends of an axis for points (x, y) beyond it; marks would look real."""
    for beyond, y, mark in (
        ([x for x, y in points if y > high], high, "^"),
        ([x for x, y in points if y < low], low, "v"),
    ):
        if beyond:
            axes.plot(beyond, [y] * len(beyond), mark, color=colour, ms=8, mew=0, zorder=4)
