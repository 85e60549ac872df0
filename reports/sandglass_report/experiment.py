"""An experiment beside methods and golden: what is measured, with its scatter, and computed."""

from collections import Counter

from sandglass_report import style
from sandglass_report.plates import MUTED, TEXT, Panel, Plate

WITHIN = 0.3  # of the measured value: runs that are farther off are not drawn but named
WORDS = {"peak": "first peak", "period": "period"}


def experiment_plate(tips, palette):
    """A plate with a panel for each family of cases with measured values; None without any.

    tips: of the verdicts.
    """
    tips = [tip for tip in tips if tip.scatter is not None and palette.knows(tip.method)]
    if not tips:
        return None
    families = dict.fromkeys(tip.family for tip in tips)
    panels = tuple(
        _panel(name, [t for t in tips if t.family == name], palette) for name in families
    )
    drawn = dict.fromkeys(tip.method for tip in tips if _close(tip))
    legend = (("measured ± scatter", MUTED, "s"),)
    legend += (("golden", style.GOLDEN[0], "_"),) * any(tip.golden is not None for tip in tips)
    legend += tuple((m, palette.colour(m), palette.mark(m)) for m in drawn)
    missing = [m for m in dict.fromkeys(tip.method for tip in tips) if m not in drawn]
    note = f"Computed over measured values ({tips[0].source})."
    note += f" Not drawn, more than {100 * WITHIN:.0f} % off: {', '.join(missing)}." * bool(missing)
    return Plate("experiment", "Against an experiment", panels, 2, note, legend)


def _close(tip):
    return tip.ok and tip.to_published is not None and abs(tip.to_published - 1) < WITHIN


def _panel(family, tips, palette):
    """Ratios over the values of all variants: each has a column."""
    rows = {}
    for tip in tips:
        rows.setdefault(tip.method, []).append(tip)
    columns = next(iter(rows.values()))

    def draw(axes):
        for x, tip in enumerate(columns):
            share = tip.scatter / abs(tip.published)
            axes.bar(x, 2 * share, 0.9, 1 - share, color=MUTED, alpha=0.4, lw=0)
            if tip.golden is not None:
                axes.plot(x, tip.golden / tip.published, "_", color=style.GOLDEN[0], ms=16, mew=2)
        axes.axhline(1, color=TEXT, lw=0.9)
        shift = 0.8 / max(len(rows) - 1, 1)
        for number, (method, row) in enumerate(rows.items()):
            points = [(x, tip.to_published) for x, tip in enumerate(row) if _close(tip)]
            mark = {"color": palette.colour(method), "marker": palette.mark(method)}
            for x, y in points:
                axes.plot(x - 0.4 + number * shift, y, ls="", ms=3.5, mew=0, **mark)
        axes.set_xticks(range(len(columns)), _names(columns))
        axes.set_ylabel("computed over measured")

    golden = {tip.variant: tip.golden / tip.published for tip in columns if tip.golden is not None}
    words = ", ".join(f"{name}: {ratio:.3f}" for name, ratio in golden.items())
    alt = f"{family}: computed over measured. " + (f"Golden: {words}" if words else "")
    return Panel(f"experiment.{family}", family, alt, draw, 560, 340)


def _names(columns):
    """Variant and feature of each column; several displacements of a variant are numbered."""
    names, count = [], Counter(tip.variant for tip in columns if tip.of == "end")
    for number, tip in enumerate(columns):
        before = sum(one.variant == tip.variant for one in columns[: number + 1])
        numbered = f"{tip.variant}, {before}" if count[tip.variant] > 1 else tip.variant
        names.append(numbered if tip.of == "end" else f"{tip.variant}\n{WORDS[tip.of]}")
    return names
