"""The drawing of the README's figure, by a template: the same text on every machine.

A row for each method: its name, a bar for its cost, its two errors on a logarithmic axis and as
numbers. Colours follow the reader's light or dark page.
"""

import math
from pathlib import Path

import jinja2

from sandglass_report import style

# Pixels: the size of the drawing and of its parts, the ends of the axes of costs and of errors, and
# the right ends of the columns of errors.
PLACES = {"WIDTH": 800, "TOP": 104, "ROW": 50, "BOTTOM": 64}
PLACES |= {"BARS": (232, 436), "ERRORS": (484, 640), "NUMBERS": (706, 784)}
REAL_TIME = 1.0  # s of wall time per simulated second


def drawing(document, rows):
    """The text of an SVG file. rows: (words, record of the document)."""
    palette = style.Palette(style.solver_methods())
    seen = [r[name] for _, r in rows for name in ("golden", "truth") if r[name] >= style.FLOOR]
    low, high = math.floor(math.log10(min(seen))), math.ceil(math.log10(max(seen)))
    # Real time and all bars are on the axis of costs.
    most = max(REAL_TIME, 1.1 * max(r["seconds_per_simulated_second"] for _, r in rows))

    def of_error(error):
        share = (math.log10(max(error, 10.0**low)) - low) / (high - low)
        return _between(share, PLACES["ERRORS"])

    def row(words, record):
        seconds = record["seconds_per_simulated_second"]
        return {
            "words": words,
            "method": record["method"],
            "colour": f"var({palette.css(record['method'])})",
            "end": _between(seconds / most, PLACES["BARS"]),
            "seconds": f"{style.plain(seconds, 2)} s",
            "below": record["golden"] < 10.0**low,
            "shown": {name: shown(record[name]) for name in ("truth", "golden")},
            **{name: of_error(record[name]) for name in ("truth", "golden")},
        }

    used = (palette.css(record["method"]) for _, record in rows)
    names = ("--ink", "--muted", "--grid", "--panel", *dict.fromkeys(used))
    schemes = [" ".join(f"{name}: {style.THEMED[name][k]};" for name in names) for k in (0, 1)]
    loader = jinja2.FileSystemLoader(Path(__file__).parent / "templates")
    environment = jinja2.Environment(loader=loader, trim_blocks=True, lstrip_blocks=True)
    environment.filters["place"] = "{:.1f}".format
    drawn = environment.get_template("headline.svg.j2").render(
        document=document,
        rows=[row(*one) for one in rows],
        ticks=[(of_error(10.0**n), style.exact_percent(10.0**n)) for n in range(low, high + 1)],
        real_time=_between(REAL_TIME / most, PLACES["BARS"]),
        light=schemes[0],
        dark=schemes[1],
        **PLACES,
    )
    return drawn + "\n"


def shown(error):
    """An error in percent; 0 if it counts as zero."""
    return "0 %" if error < style.FLOOR else style.percent(error, 2)


def _between(share, ends):
    """The position at a share of the way between two ends."""
    return ends[0] + share * (ends[1] - ends[0])
