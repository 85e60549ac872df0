"""Bending and locking: deflections of cantilevers over Poisson's ratio and mesh density."""

import re

from sandglass_report import style
from sandglass_report.plates import MUTED, Panel, Plate

VARIANT = re.compile(r"(?P<elements>\d+) nu(?P<nu>0?\.\d+)")
CEILING = 1.45  # values beyond are drawn at the edge


def bending_plates(tips, palette):
    """Two plates, over Poisson's ratio and over elements, or none without such a family.

    tips: of the verdicts. Uses families whose variants are named "ELEMENTS nuVALUE".
    """
    found = {}
    for tip in tips:
        match = VARIANT.fullmatch(tip.variant)
        if match and tip.ok and tip.to_truth is not None and palette.knows(tip.method):
            found[tip.method, int(match["elements"]), float(match["nu"])] = tip.to_truth
    if not found:
        return ()
    elements = sorted({e for _, e, _ in found})
    ratios = sorted({nu for _, _, nu in found})
    methods = [m for m in palette.methods if any(key[0] == m for key in found)]
    legend = tuple((m, palette.colour(m), palette.mark(m)) for m in methods)
    words = {e: f"{e} element{'s' if e > 1 else ''} through the thickness" for e in elements}
    locking, bending = [], []
    for e in elements:
        curves = {m: [found.get((m, e, nu)) for nu in ratios] for m in methods}
        locking.append(_panel(f"locking.{e}", words[e], "Poisson’s ratio", ratios, curves, palette))
    for nu in dict.fromkeys((ratios[0], *ratios[-2:])):
        curves = {m: [found.get((m, e, nu)) for e in elements] for m in methods}
        title, across = f"Poisson’s ratio {nu:g}", "elements through the thickness"
        bending.append(_panel(f"bending.{nu:g}", title, across, elements, curves, palette))
    note = (
        "Deflection of the tip over that of the truth; 1 is exact, less is too stiff. Values above "
        f"{CEILING:g} are drawn as arrowheads at the edge."
    )
    return (
        Plate(
            "locking",
            "Locking: as the body becomes incompressible",
            tuple(locking),
            3,
            note,
            legend,
        ),
        Plate("bending", "Bending: as the mesh becomes finer", tuple(bending), 3, note, legend),
    )


def _panel(name, title, across, values, curves, palette):
    """One panel: a line per method over equally spaced values."""

    def draw(axes):
        axes.axhline(1.0, color=MUTED, lw=0.9, ls="--")
        for i, (method, ratios) in enumerate(curves.items()):
            # Slightly shifted, so that equal methods are visible next to each other.
            aside = 0.012 * (i - len(curves) / 2)
            known = [(x + aside, r) for x, r in enumerate(ratios) if r is not None]
            if not known:
                continue
            xs, ys = zip(*known)
            strokes = {"color": palette.colour(method), "lw": 1.0, "ms": 5}
            shown = [min(y, CEILING) for y in ys]
            axes.plot(xs, shown, f"-{palette.mark(method)}", **strokes, mew=0)
            beyond = [x for x, y in known if y > CEILING]
            above = [CEILING + 0.025] * len(beyond)
            axes.plot(beyond, above, "^", color=strokes["color"], ms=6, mew=0)
        axes.set_ylim(0, CEILING + 0.05)
        axes.set_xlim(-0.3, len(values) - 0.7)
        axes.set_xticks(range(len(values)), [f"{v:g}" for v in values])
        axes.set_xlabel(across)
        axes.set_ylabel("deflection over the truth’s")

    alt = f"{title}: deflection of the tip over that of the truth. " + _in_words(values, curves)
    return Panel(name, title, alt, draw, 400, 330)


def _in_words(values, curves):
    parts = []
    for method, ratios in curves.items():
        known = [f"{style.plain(r)} at {v:g}" for v, r in zip(values, ratios) if r is not None]
        if known:
            parts.append(f"{method}: {', '.join(known)}")
    return "; ".join(parts)
