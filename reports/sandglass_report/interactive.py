"""The data of the page's scripts: the main chart's points, and Plotly itself, compressed."""

import base64
import functools
import gzip

from common.errors import InputError
from sandglass_report import style
from sandglass_report.measured import OWN_MESH
from sandglass_report.points import families, fronts
from sandglass_report.quantities import COSTS, FIGURES, QUANTITIES

# Findings of verify that mean failure, not inaccuracy.
FAILURES = ("hourglassing", "locking", "inverted", "unstable", "not at rest")


# The mark of the entries in results/: other programs, and ours beside them.
OTHER = {"css": "--ink", "symbol": "star"}


def chart_data(points, palette, others=()):
    """The data for chart.js: points, fronts, adaptive lines, and the methods' colours and marks.

    others: Points of results/, which are drawn as stars. Those of another machine or revision are
    neither on a front nor in the headline.
    """
    shown = [*points, *others]
    return {
        "own_mesh": OWN_MESH,
        "points": [p.as_record() | {"fails": not p.ok or p.finding in FAILURES} for p in shown],
        "fronts": fronts(shown),
        "costs": {name: _words(QUANTITIES[name]) for name in COSTS},
        "figures": {name: _words(QUANTITIES[name]) for name in FIGURES},
        "families": families(points),
        "methods": {
            m: {"css": palette.css(m), "symbol": style.PLOTLY_MARKS[palette.mark(m)]}
            for m in palette.methods
        }
        | {p.method: OTHER for p in others},
    }


def _words(quantity):
    """Texts that the script writes at axes and marks, and shows on request."""
    return {"title": quantity.name, "head": quantity.head, "definition": quantity.definition}


@functools.cache
def packed_plotly():
    """Plotly's script, compressed, as base64: a quarter of its size. Raises InputError."""
    try:
        from plotly.offline import get_plotlyjs

        script = get_plotlyjs()
    except (ImportError, OSError) as error:
        raise InputError(
            f"plotly: is missing: {error}; package python3-plotly (ci/setup report)"
        ) from error
    return base64.b64encode(gzip.compress(script.encode(), 9, mtime=0)).decode("ascii")
