"""Failure maps: the outcome of every method along two axes, one small map per method."""

from dataclasses import dataclass

from matplotlib.patches import Rectangle

from common.files import read_json
from common.records import NUMBER, entry
from sandglass_report import style
from sandglass_report.plates import MUTED, Panel, Plate

COLUMNS = 5
CELL = 30  # pixels
GOLDEN_FAILS = "the golden fails"
REFUSED = "not supported"

# Outcome -> colour and letter; the letter is that of the command line, for those who cannot see
# the colours.
OUTCOMES = {
    "good": ("#9bd3ae", "."),
    "inaccurate": ("#f3dd85", "o"),
    "hourglassing": ("#c9a2dd", "H"),
    "locking": ("#8fbce8", "L"),
    "inverted": ("#ef9a8c", "I"),
    "unstable": ("#c8553d", "U"),
    "not at rest": ("#b9a58f", "R"),
    "not judged": ("#c3ccd6", "~"),
    GOLDEN_FAILS: ("#d9dde2", "?"),
    REFUSED: ("#f4f5f7", "-"),
}


def read_maps(path):
    """The maps of a case, as `sandglass stability --json` writes them. Raises InputError."""
    document = read_json(path, "sandglass stability --json")
    for key, kind in (("case", str), ("limit", NUMBER), ("maps", list), ("revision", str)):
        entry(path, document, key, kind)
    return document


def outcome(cell):
    """The word for a cell: its finding, or the reason why there is none."""
    if cell["refused"]:
        return REFUSED
    return cell["finding"] or GOLDEN_FAILS


def words_in(cell):
    """The text of a cell: the error in percent if the method works, otherwise a letter."""
    word = outcome(cell)
    if word not in ("good", "inaccurate"):
        return OUTCOMES[word][1]
    percent = 100 * cell["symptoms"]["error"]
    if percent < 0.001:
        return "0"
    return f"{percent:.0f}" if percent >= 9.5 else f"{percent:.1g}"


def map_plates(document):
    """One plate per map of a case, one panel per method."""
    return [_plate(document, one) for one in document["maps"] if one["cells"]]


def _plate(document, one):
    case, limit = document["case"], style.exact_percent(round(document["limit"], 4))
    methods = dict.fromkeys(cell["method"] for cell in one["cells"])
    panels = tuple(_panel(case, one, method) for method in methods)
    shown = {outcome(cell) for cell in one["cells"]}
    legend = tuple(
        (f"{letter}  {word}" if letter.isupper() else word, colour, "s")
        for word, (colour, letter) in OUTCOMES.items()
        if word in shown
    )
    axes = [axis for axis in (one["x"], one["y"]) if axis]
    note = "; ".join(f"{axis['name']}: {axis['meaning']}" for axis in axes)
    note += ". Numbers: largest distance in % from the golden's element on the same mesh"
    note += f"; good up to {limit}, unless an axis states another limit"
    title = f"{case}: " + " and ".join(axis["name"] for axis in axes)
    return Plate(f"stability.{case}.{one['name']}", title, panels, COLUMNS, note, legend)


def _panel(case, one, method):
    xs = one["x"]["values"]
    ys = one["y"]["values"] if one["y"] else [0.0]
    cells = {(c["x"], c["y"]): c for c in one["cells"] if c["method"] == method}

    written = {"ha": "center", "va": "center", "color": style.INK[0], "fontsize": 7.5}

    def draw(axes):
        axes.grid(False)
        for i, x in enumerate(xs):
            for j, y in enumerate(ys):
                colour, _ = OUTCOMES[outcome(cells[x, y])]
                axes.add_patch(Rectangle((i, j), 1, 1, facecolor=colour, edgecolor="white"))
                axes.text(i + 0.5, j + 0.47, words_in(cells[x, y]), **written)
        axes.set_xlim(0, len(xs))
        axes.set_ylim(0, len(ys))
        axes.set_xticks([i + 0.5 for i in range(len(xs))], [f"{x:g}" for x in xs], fontsize=7)
        axes.set_yticks([j + 0.5 for j in range(len(ys))], [f"{y:g}" for y in ys], fontsize=7)
        axes.tick_params(length=0)
        axes.spines[:].set_visible(False)
        axes.set_xlabel(one["x"]["name"], color=MUTED)
        axes.set_ylabel(one["y"]["name"] if one["y"] else "", color=MUTED)
        if not one["y"]:
            axes.set_yticks([])

    outcomes = [outcome(cell) for cell in cells.values()]
    words = ", ".join(f"{outcomes.count(word)} {word}" for word in OUTCOMES if word in outcomes)
    alt = f"{case}, {method}: of {len(cells)} cells {words}"
    width, height = max(190, 62 + CELL * len(xs)), 62 + CELL * len(ys)
    return Panel(f"stability.{case}.{one['name']}.{method}", method, alt, draw, width, height)


@dataclass(frozen=True)
class MapTable:
    """One method's map as rows of cells from the largest y to the smallest: (word, text, title)."""

    method: str
    rows: tuple  # (y or None, cells)


@dataclass(frozen=True)
class MapText:
    """A map of a case as text: one table per method."""

    name: str  # of the figure that has the same map
    title: str
    note: str
    x: dict
    y: dict | None
    tables: tuple
    outcomes: tuple  # words that occur, in the order of the legend


def map_texts(documents):
    """The maps of all cases as tables."""
    return tuple(_text(d, one) for d in documents for one in d["maps"] if one["cells"])


def _text(document, one):
    plate = _plate(document, one)
    by_place = {(c["method"], c["x"], c["y"]): c for c in one["cells"]}
    methods = dict.fromkeys(c["method"] for c in one["cells"])
    ys = reversed(one["y"]["values"]) if one["y"] else [None]
    rows = {m: [] for m in methods}
    for y in ys:
        for m in methods:
            at = [by_place[m, x, 0.0 if y is None else y] for x in one["x"]["values"]]
            rows[m].append((y, tuple((outcome(c), words_in(c), _whole(c)) for c in at)))
    tables = tuple(MapTable(m, tuple(found)) for m, found in rows.items())
    seen = {outcome(cell) for cell in one["cells"]}
    shown = tuple(word for word in OUTCOMES if word in seen)
    return MapText(plate.name, plate.title, plate.note, one["x"], one["y"], tables, shown)


def _whole(cell):
    """All details of a cell, as text."""
    error = (cell["symptoms"] or {}).get("error")
    return outcome(cell) + ("" if error is None else f", {style.percent(error)}")


def kept(document):
    """The document reduced to what the page shows of each cell, with errors to three digits."""
    cells = {one["name"]: [_kept(cell) for cell in one["cells"]] for one in document["maps"]}
    return document | {"maps": [one | {"cells": cells[one["name"]]} for one in document["maps"]]}


def _kept(cell):
    names = ("method", "x", "y", "finding", "golden_failed", "refused")
    error = (cell["symptoms"] or {}).get("error")
    symptoms = None if error is None else {"error": float(f"{error:.3g}")}
    return {name: cell[name] for name in names} | {"symptoms": symptoms}
