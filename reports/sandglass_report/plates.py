"""Panels and plates: one drawing, shown in the page as themed SVG and saved as static figures."""

import io
import re
import textwrap
from collections.abc import Callable
from dataclasses import dataclass

import matplotlib

matplotlib.use("agg")

from matplotlib import pyplot  # noqa: E402 (the backend must be chosen first)
from matplotlib.lines import Line2D  # noqa: E402

from sandglass_report import style  # noqa: E402

PIXELS_PER_INCH = 96
LEGEND_WIDTH = 2.0  # inches
LETTERS_PER_INCH = 15  # of a note
TEXT = style.INK[0]
MUTED = style.MUTED[0]

BASE = {
    "font.family": "DejaVu Sans",
    "font.size": 8.25,
    "axes.titlesize": 9,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.facecolor": "none",
    "axes.linewidth": 0.8,
    "grid.color": style.GRID[0],
    "grid.linewidth": 0.7,
    "text.color": TEXT,
    "figure.facecolor": "none",
    "svg.hashsalt": "sandglass",
    "path.simplify": True,
}
BASE |= dict.fromkeys(("axes.edgecolor", "axes.labelcolor", "xtick.color", "ytick.color"), MUTED)
BASE |= dict.fromkeys(("axes.spines.top", "axes.spines.right"), False)
BASE |= dict.fromkeys(("axes.grid", "axes.axisbelow"), True)
BASE |= {f"{axis}tick.{kind}.size": n for axis in "xy" for kind, n in (("major", 3), ("minor", 0))}


@dataclass(frozen=True)
class Panel:
    """One drawing. `draw` fills an Axes; title and alt are plain text, sizes are in CSS pixels."""

    name: str  # for file names and ids: a-z, 0-9, - and .
    title: str
    alt: str  # alternative text for readers who cannot see the picture
    draw: Callable
    width: int = 320
    height: int = 270
    missing: str = ""  # the reason why there is nothing to draw, shown instead


@dataclass(frozen=True)
class Plate:
    """Panels that belong together, in `columns` columns in the static figure."""

    name: str
    title: str
    panels: tuple
    columns: int
    note: str = ""
    legend: tuple = ()  # (words, colour, mark) of items without a label in the panels


def inline_svg(panel):
    """The panel as an SVG element that takes its colours from the page's custom properties."""
    with matplotlib.rc_context(BASE | {"svg.fonttype": "none"}):
        size = panel.width / PIXELS_PER_INCH, panel.height / PIXELS_PER_INCH
        figure, axes = pyplot.subplots(figsize=size, layout="constrained")
        figure.get_layout_engine().set(w_pad=0.03, h_pad=0.03)
        try:
            _draw(panel, axes)
            buffer = io.StringIO()
            figure.savefig(buffer, format="svg", transparent=True, metadata={"Date": None})
        finally:
            pyplot.close(figure)
    return themed(buffer.getvalue(), panel)


def themed(svg, panel):
    """Matplotlib's SVG document as a compact element for a page, with unique ids."""
    start = svg.index("<svg")
    svg = svg[start:]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    svg = re.sub(r"<!--.*?-->", "", svg, flags=re.DOTALL)
    svg = re.sub(r' (xmlns(:xlink)?|version)="[^"]*"', "", svg)
    head = f'<svg role="img" aria-label="{_escaped(panel.alt)}"'
    svg = re.sub(r'<svg (width|height)="[^"]*"', "<svg", svg)
    svg = re.sub(r'^<svg([^>]*?) (?:width|height)="[^"]*"', r"<svg\1", svg)
    svg = re.sub(r'^<svg([^>]*?) (?:width|height)="[^"]*"', r"<svg\1", svg)
    svg = head + svg.removeprefix("<svg")
    used = set(re.findall(r'(?:url\(|href=")#([^)"]+)', svg))
    svg = re.sub(r' id="([^"]+)"', lambda m: _own_id(m[1], used, panel.name), svg)
    svg = re.sub(r'(url\(|href=")#', rf"\1#{panel.name}-", svg)
    svg = re.sub(r'(?<= d=")[^"]+', lambda m: _rounded(m[0]), svg)
    for name, (light, _) in style.THEMED.items():
        svg = re.sub(rf"{light}\b", f"var({name})", svg)
    # The page's own font is narrower than the one the text was laid out with.
    svg = re.sub(r"'DejaVu Sans'(, [^;\"]*)?", "var(--font)", svg)
    return re.sub(r"\n\s*", "\n", svg).strip()


def save_plate(plate, folder):
    """Writes the plate to a folder as NAME.svg and NAME.png, on white. Returns the two paths."""
    rows = -(-len(plate.panels) // plate.columns)
    unused = rows * plate.columns - len(plate.panels)
    width = plate.columns * plate.panels[0].width / PIXELS_PER_INCH
    width += LEGEND_WIDTH if plate.legend else 0
    height = rows * (min(max(p.height for p in plate.panels), 440) + 14) / PIXELS_PER_INCH + 0.45
    colours = {"figure.facecolor": "#ffffff", "svg.fonttype": "path"}
    with matplotlib.rc_context(BASE | colours):
        figure, grid = pyplot.subplots(
            rows, plate.columns, figsize=(width, height), layout="constrained", squeeze=False
        )
        figure.get_layout_engine().set(w_pad=0.08, h_pad=0.06)
        try:
            for axes, panel in zip(grid.flat, plate.panels):
                _draw(panel, axes)
                axes.set_title(panel.title, pad=8)
            for axes in list(grid.flat)[-unused:] if unused else []:
                axes.set_axis_off()
            figure.suptitle(plate.title, x=0.01, ha="left", fontsize=12, fontweight="bold")
            if plate.legend:
                _draw_legend(figure, plate.legend)
            if plate.note:
                note = textwrap.fill(plate.note, int(LETTERS_PER_INCH * width))
                figure.supxlabel(note, x=0.01, ha="left", fontsize=8.25, color=MUTED)
            paths = folder / f"{plate.name}.svg", folder / f"{plate.name}.png"
            figure.savefig(paths[0], metadata={"Date": None})
            figure.savefig(paths[1], dpi=160)
        finally:
            pyplot.close(figure)
    return paths


def _draw_legend(figure, entries):
    """A legend of names and marks, to the right of all panels."""
    share = LEGEND_WIDTH / figure.get_figwidth()
    figure.get_layout_engine().set(rect=(0, 0, 1 - share, 1))
    marks = [
        Line2D([], [], linestyle="", marker=mark, color=colour, label=words)
        for words, colour, mark in entries
    ]
    place = {"loc": "center left", "bbox_to_anchor": (1 - share, 0.5)}
    figure.legend(handles=marks, **place, frameon=False, fontsize=8.25)


def _draw(panel, axes):
    """Fills an Axes with the panel, or with the reason why it is empty."""
    if not panel.missing:
        panel.draw(axes)
        return
    axes.set_axis_off()
    words = panel.missing.replace(" for ", "\nfor ")
    where = {"transform": axes.transAxes, "ha": "center", "va": "center"}
    axes.text(0.5, 0.5, words, color=MUTED, linespacing=1.6, **where)


def _own_id(name, used, prefix):
    """An id prefixed with the panel's name if something refers to it; no id otherwise."""
    return f' id="{prefix}-{name}"' if name in used else ""


def _rounded(path):
    """Path data with two decimals: a hundredth of a point is beyond a screen's resolution."""
    return re.sub(r"-?\d+\.\d+", lambda m: f"{float(m[0]):.2f}".rstrip("0").rstrip("."), path)


def _escaped(text):
    for sign, name in (("&", "&amp;"), ('"', "&quot;"), ("<", "&lt;"), (">", "&gt;")):
        text = text.replace(sign, name)
    return text
