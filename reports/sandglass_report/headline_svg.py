"""The drawing of the README's figure, written by hand: the same text on every machine.

A row for each method: its name, a bar for its cost, its two errors on a logarithmic axis and as
numbers. Colours follow the reader's light or dark page.
"""

import math

from sandglass_report import style

WIDTH, TOP, ROW, BOTTOM = 800, 104, 50, 64
BARS = 232, 436  # left and right ends of the axis of costs
ERRORS = 484, 640  # of the axis of errors
NUMBERS = 706, 784  # right ends of the columns of errors
REAL_TIME = 1.0  # s of wall time per simulated second


def drawing(document, rows):
    """The text of an SVG file. rows: (words, record of the document)."""
    palette = style.Palette(style.solver_methods())
    costs = _costs(record["seconds_per_simulated_second"] for _, record in rows)
    errors = _decades(record[name] for _, record in rows for name in ("golden", "truth"))
    height = TOP + ROW * len(rows) + BOTTOM
    parts = [_head(height, [palette.css(r["method"]) for _, r in rows])]
    parts += _titles(document)
    parts += _axes(costs, errors, TOP + ROW * len(rows))
    for i, (words, record) in enumerate(rows):
        parts += _row(TOP + ROW * i, words, record, palette, costs, errors)
    return "\n".join([*parts, "</svg>", ""])


def _costs(seconds):
    """The largest value of the axis of costs: real time and all bars are on it."""
    return max(REAL_TIME, 1.1 * max(seconds))


def _decades(errors):
    """The exponents at the ends of the axis of errors, without those that count as zero."""
    seen = [error for error in errors if error >= style.FLOOR]
    return math.floor(math.log10(min(seen))), math.ceil(math.log10(max(seen)))


def _at(value, ends):
    """The place of a share between two ends."""
    return ends[0] + value * (ends[1] - ends[0])


def _of_error(error, decades):
    """The place of an error on its axis; its left end for those below it."""
    low, high = decades
    share = (math.log10(max(error, 10.0**low)) - low) / (high - low)
    return _at(share, ERRORS)


def _head(height, used):
    """The opening of the file with its colours."""
    names = ("--ink", "--muted", "--grid", "--panel", *dict.fromkeys(used))

    def colours(which):
        return " ".join(f"{name}: {style.THEMED[name][which]};" for name in names)

    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" '
        f'width="{WIDTH}" height="{height}" font-family="system-ui, -apple-system, \'Segoe UI\', '
        'Helvetica, Arial, sans-serif" font-size="13">\n'
        f"<style>svg {{ {colours(0)} }} "
        f"@media (prefers-color-scheme: dark) {{ svg {{ {colours(1)} }} }} "
        "text { fill: var(--ink) } .quiet { fill: var(--muted); font-size: 12px } "
        ".line { stroke: var(--grid) } .end { text-anchor: end } .mid { text-anchor: middle }"
        "</style>\n"
        f'<rect x="0.5" y="0.5" width="{WIDTH - 1}" height="{height - 1}" rx="8" '
        'fill="var(--panel)" stroke="var(--grid)"/>'
    )


def _text(x, y, words, kind="", more=""):
    kind = f' class="{kind}"' if kind else ""
    return f'<text x="{x:.1f}" y="{y:.1f}"{kind}{more}>{words}</text>'


def _line(x0, y0, x1, y1, more='class="line"'):
    return f'<line x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}" {more}/>'


def _titles(document):
    bold = ' font-weight="600"'
    heads = ((NUMBERS[0], "● truth"), (NUMBERS[1], "○ golden"))
    return [
        _text(
            16,
            30,
            f"{document['case']}: cost and error of five methods",
            "",
            ' font-weight="700" font-size="16"',
        ),
        _text(
            16,
            50,
            f"{document['elements']} elements, double, one thread. Further left is better in both.",
            "quiet",
        ),
        _text(BARS[0], TOP - 18, "wall time per simulated second", "", bold),
        _text(ERRORS[0], TOP - 18, "largest error to the", "", bold),
        *(_text(x, TOP - 18, words, "end", bold) for x, words in heads),
    ]


def _axes(costs, errors, bottom):
    parts = []
    for exponent in range(errors[0], errors[1] + 1):
        x = _of_error(10.0**exponent, errors)
        parts.append(_line(x, TOP - 6, x, bottom))
        parts.append(_text(x, bottom + 18, style.exact_percent(10.0**exponent), "quiet mid"))
    x = _at(REAL_TIME / costs, BARS)
    dashed = 'stroke="var(--muted)" stroke-dasharray="4 3"'
    parts.append(_line(BARS[0], TOP - 6, BARS[0], bottom))
    parts.append(_line(x, TOP - 6, x, bottom, dashed))
    parts.append(_text(x, bottom + 18, "real time, 1 s", "quiet end"))
    parts.append(_text(BARS[0], bottom + 18, "0", "quiet mid"))
    note = (
        "Arrow: below the axis. Golden: the simplest element that does not lock, on the same mesh; "
        "truth: much finer meshes."
    )
    parts.append(_text(16, bottom + 44, note, "quiet"))
    return parts


def _row(top, words, record, palette, costs, errors):
    method, middle = record["method"], top + ROW / 2
    colour = f"var({palette.css(method)})"
    seconds = record["seconds_per_simulated_second"]
    end = _at(seconds / costs, BARS)
    parts = [
        _line(16, top, WIDTH - 16, top),
        _text(16, middle - 3, method, "", ' font-weight="600"'),
        _text(16, middle + 14, words, "quiet"),
        f'<rect x="{BARS[0]}" y="{middle - 8:.1f}" width="{end - BARS[0]:.1f}" height="16" rx="2" '
        f'fill="{colour}"/>',
        _text(end + 6, middle + 5, f"{style.plain(seconds, 2)} s"),
    ]
    truth, golden = (_of_error(record[name], errors) for name in ("truth", "golden"))
    stroke = f'stroke="{colour}" stroke-width="2"'
    parts.append(_line(min(truth, golden), middle, max(truth, golden), middle, stroke))
    if record["golden"] < 10.0 ** errors[0]:
        x = golden - 2
        parts.append(f'<path d="M{x:.1f} {middle:.1f} l8 -5 v10 z" fill="{colour}"/>')
    else:
        parts.append(
            f'<circle cx="{golden:.1f}" cy="{middle:.1f}" r="5.5" fill="var(--panel)" {stroke}/>'
        )
    parts.append(f'<circle cx="{truth:.1f}" cy="{middle:.1f}" r="6" fill="{colour}"/>')
    for x, name in zip(NUMBERS, ("truth", "golden")):
        error = record[name]
        shown = "0 %" if error < style.FLOOR else style.percent(error, 2)
        parts.append(_text(x, middle + 5, shown, "end"))
    return parts
