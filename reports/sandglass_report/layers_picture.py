"""The include graph of the solver: its layers as stairs, and what each includes to the left of it.

Layers and includes are those of `ci/layers.py`, which checks them.
"""

import math
from collections import Counter
from pathlib import Path

import layers
from sandglass_report.svg import INK, MUTED, Drawing

ROOT = Path(__file__).resolve().parents[2]

STEP, ROW = 62, 46  # from a layer to the next, to the right and down
LEFT, TOP = 40, 20


def include_counts(solver):
    """(layer, the layer it includes) -> number of includes, without those of a layer by itself."""
    found = Counter((layer, included) for _, _, layer, included in layers.includes(solver))
    return {pair: n for pair, n in found.items() if pair[0] != pair[1]}


def layers_picture(solver=ROOT / "solver"):
    """The picture as SVG text."""
    counts, wrong = include_counts(solver), len(layers.wrong_includes(solver))
    last = len(layers.LAYERS) - 1
    caption = f"{sum(counts.values())} includes between {last + 1} layers, pointing right: {wrong}"
    drawing = Drawing(
        LEFT + last * STEP + 140,
        2 * TOP + (last + 1) * ROW,
        "The solver's layers, and what each includes",
        "; ".join(f"{a} includes {b}: {n}" for (a, b), n in sorted(counts.items())),
    )
    for k in range(last + 1):
        rows = [layers.LAYERS.index(a) for a, b in counts if b == layers.LAYERS[k]]
        columns = [layers.LAYERS.index(b) for a, b in counts if a == layers.LAYERS[k]]
        drawing.line(_x(k), _y(k), _x(k), _y(max([k, *rows])))
        if columns:
            drawing.line(_x(k), _y(k), _x(min([k, *columns])) - 34, _y(k), arrow=True)
    for (layer, included), n in counts.items():
        _draw_count(drawing, layers.LAYERS.index(included), layers.LAYERS.index(layer), n)
    for k, layer in enumerate(layers.LAYERS):
        drawing.box(_x(k) - 24, _y(k) - 16, 18 + 13 * len(layer), 32)
        drawing.words(_x(k) - 12, _y(k) + 6, layer, bold=True)
    _draw_caption(drawing, counts, caption)
    return drawing.text()


def _x(column):
    return LEFT + column * STEP


def _y(row):
    return TOP + ROW // 2 + row * ROW


def _draw_count(drawing, column, row, n):
    """The more includes, the darker; one that points right is red and lies above the stairs."""
    share = min(1.0, math.log(n + 1) / math.log(32))
    light = [round(240 - share * (240 - dark)) for dark in (0x4A, 0xA8, 0xE8)]
    fill = "#{:02x}{:02x}{:02x}".format(*light) if column < row else "#ff5a4f"
    drawing.circle(_x(column), _y(row), 17, fill)
    drawing.words(_x(column), _y(row) + 6, str(n), 17, anchor="middle")


def _draw_caption(drawing, counts, caption):
    """In the corner that is empty because nothing points right."""
    layer, included = max(counts, key=counts.get)
    lines = (
        (caption, 20, INK, True),
        (f"From a layer go left: {layer} includes", 18, MUTED, False),
        (f"headers of {included} {counts[layer, included]} times.", 18, MUTED, False),
    )
    for k, (words, size, colour, bold) in enumerate(lines):
        where = _x(len(layers.LAYERS) - 1) + 120, _y(0) + 8 + 30 * k
        drawing.words(*where, words, size, colour, bold, anchor="end")
