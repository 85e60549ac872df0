"""Colours, marks and words that every chart shares, in a light and a dark form."""

import math
import re
from pathlib import Path

METHODS_HEADER = Path(__file__).resolve().parents[2] / "solver/element/methods.hpp"

# Okabe and Ito's colours, distinguishable for colour-blind readers, and a brighter form for dark
# pages; the last ones are distinguishable only together with their marks.
METHOD_COLOURS = (
    ("#d55e00", "#ff8a45"),  # vermilion
    ("#0072b2", "#4aa8e8"),  # blue
    ("#b8609a", "#e59cc9"),  # reddish purple
    ("#009e73", "#2fcf9f"),  # green
    ("#4bb1e6", "#86d0f7"),  # sky blue
    ("#8a6d00", "#d9bc4a"),  # olive
    ("#6b4fa3", "#b39ae6"),  # violet
    ("#7a4a2b", "#d0986f"),  # brown
    ("#a3123a", "#f2708f"),  # crimson
    ("#2f7f86", "#7fc9cf"),  # teal
    ("#5d6b1c", "#b9c65c"),  # moss
    ("#4b5563", "#a9b6c6"),  # slate
)
METHOD_MARKS = ("X", "o", "s", "D", "^", "v", "P", "h")
PLOTLY_MARKS = dict(
    zip(METHOD_MARKS, "x circle square diamond triangle-up triangle-down cross hexagon".split())
)
GLYPHS = dict(zip(METHOD_MARKS, "✖●■◆▲▼✚⬢"))  # the marks in running text

GOLDEN = ("#d99200", "#f5bd41")
INK = ("#1d232b", "#e8ebef")
MUTED = ("#626b76", "#9aa4b0")
GRID = ("#e1e5ea", "#343b44")
PANEL = ("#fefefe", "#1b2027")
BAD = ("#b3261e", "#ff8f84")

# Sentinel of a light colour in an SVG -> the custom property of the page that replaces it.
THEMED = {
    "--golden": GOLDEN,
    "--ink": INK,
    "--muted": MUTED,
    "--grid": GRID,
    "--panel": PANEL,
    "--bad": BAD,
} | {f"--method-{i}": colours for i, colours in enumerate(METHOD_COLOURS)}

# Errors below this count as zero; they are drawn on this line and labelled.
FLOOR = 1e-5

FIGURE_NAMES = {
    "max_relative_error": "max, all nodes",
    "profile_relative_error": "max, profile line",
    "rms_relative_error": "rms",
    "relative_error": "error",
}


def why_empty(subject, reference):
    """The reason why a chart of a case against a reference is empty."""
    if getattr(subject, reference) is None:
        return f"no {reference} is stored"
    return f"no run has a figure against the {reference}"


def solver_methods(header=METHODS_HEADER):
    """Names of the solver's methods in the order of its list, as in verdicts: tl-none, ...."""
    text = Path(header).read_text(encoding="utf-8")
    listed = re.search(r"using Methods =\s*TypeList<([^>]*)>", text)
    types = re.findall(r"\w+", listed[1])
    return tuple(re.sub(r"(?<=.)(?=[A-Z])", "-", name).lower() for name in types)


class Palette:
    """Colour and mark of every method, determined by the order of the solver's list only."""

    def __init__(self, methods):
        self._index = {method: i for i, method in enumerate(methods)}

    @property
    def methods(self):
        """Names of the methods, in the solver's order."""
        return tuple(self._index)

    def knows(self, method):
        """Whether a method is in the list."""
        return method in self._index

    def colour(self, method):
        """Colour on a light page, a key of the themed colours."""
        return METHOD_COLOURS[self._index[method] % len(METHOD_COLOURS)][0]

    def css(self, method):
        """The custom property with the method's colour."""
        return f"--method-{self._index[method] % len(METHOD_COLOURS)}"

    def mark(self, method):
        """Marker of matplotlib; pairs of colour and marker differ even if colours repeat."""
        shift = self._index[method] // len(METHOD_COLOURS)
        return METHOD_MARKS[(self._index[method] + shift) % len(METHOD_MARKS)]

    def glyph(self, method):
        """The mark as a character."""
        return GLYPHS[self.mark(method)]


def percent(fraction, digits=3):
    """A fraction as text in percent: 0.0512 -> "5.12 %"; tiny ones as a power of ten."""
    if fraction is None or not math.isfinite(fraction):
        return "–"
    value = 100 * fraction
    if value != 0 and abs(value) < 1e-4:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{mantissa}·10{superscript(int(exponent))} %"
    return f"{plain(value, digits)} %"


def exact_percent(fraction):
    """A round fraction, such as a limit, in percent without padding: 0.002 -> "0.2 %"."""
    return f"{format(100 * fraction, '.6f').rstrip('0').rstrip('.')} %"


def plain(value, digits=3):
    """A number with this many significant digits, never in exponent form."""
    if value == 0:
        return "0"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{decimals}f}"


def power(value):
    """A number like 1.2·10⁻⁸."""
    if not value:
        return "0"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}·10{superscript(int(exponent))}"


def superscript(number):
    """An integer in superscript digits."""
    return str(number).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
