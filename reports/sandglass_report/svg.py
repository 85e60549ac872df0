"""A drawing of boxes, lines and words as SVG text: the same bytes from the same data, everywhere.

Lengths are CSS pixels, from the upper left corner. On white, so that it is read on dark pages, too.
"""

from html import escape

INK, MUTED, LINE = "#1d232b", "#626b76", "#8a94a0"
SANS = "Helvetica, Arial, 'DejaVu Sans', sans-serif"
MONO = "'DejaVu Sans Mono', Menlo, Consolas, monospace"


class Drawing:
    """What is drawn first lies below."""

    def __init__(self, width, height, title, description):
        self._lines = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
            f'width="{width}" height="{height}" role="img" font-family="{SANS}">',
            f"<title>{escape(title, False)}</title>",
            f"<desc>{escape(description, False)}</desc>",
            '<marker id="head" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" '
            f'markerHeight="7" orient="auto"><path d="M0 0L10 5L0 10z" fill="{LINE}"/></marker>',
            f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
        ]

    def box(self, x, y, width, height, fill="#eef3f8", dashed=False):
        """A box with round corners; dashed ones are files."""
        dash = ' stroke-dasharray="6 4"' if dashed else ""
        self._lines.append(
            f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="8" fill="{fill}" '
            f'stroke="{LINE}"{dash}/>'
        )

    def circle(self, x, y, radius, fill):
        self._lines.append(f'<circle cx="{x}" cy="{y}" r="{radius}" fill="{fill}"/>')

    def line(self, x, y, to_x, to_y, arrow=False):
        """A straight line, with an arrow head at its end where it is an arrow."""
        head = ' marker-end="url(#head)"' if arrow else ""
        self._lines.append(f'<path d="M{x} {y}L{to_x} {to_y}" stroke="{LINE}"{head}/>')

    def words(self, x, y, text, size=18, colour=INK, bold=False, mono=False, anchor="start"):
        """One line of text, its base line at y."""
        style = f' font-family="{MONO}"' if mono else ""
        style += ' font-weight="bold"' if bold else ""
        style += f' text-anchor="{anchor}"' if anchor != "start" else ""
        where = f'x="{x}" y="{y}" font-size="{size}" fill="{colour}"'
        self._lines.append(f"<text {where}{style}>{escape(text, False)}</text>")

    def text(self):
        """The SVG document."""
        return "\n".join([*self._lines, "</svg>", ""])
