"""The data of the page's scripts: the main chart's points, and Plotly itself, compressed."""

import base64
import functools
import gzip

from common.errors import InputError
from sandglass_report import style
from sandglass_report.measured import OWN_MESH
from sandglass_report.points import families, fronts

# Findings of verify that mean failure, not inaccuracy.
FAILURES = ("hourglassing", "locking", "inverted", "unstable", "not at rest")


# The mark of entries of results/: other programs, and ours beside them.
OTHER = {"css": "--ink", "symbol": "star"}


def chart_data(points, palette, others=()):
    """The data for chart.js: points, fronts, adaptive lines, and the methods' colours and marks.

    others: Points of results/. They were timed on another machine, so no front has them.
    """
    shown = [*points, *others]
    return {
        "own_mesh": OWN_MESH,
        "points": [p.as_record() | {"fails": not p.ok or p.finding in FAILURES} for p in shown],
        "fronts": fronts(points),
        "families": families(points),
        "methods": {
            m: {"css": palette.css(m), "symbol": style.PLOTLY_MARKS[palette.mark(m)]}
            for m in palette.methods
        }
        | {p.method: OTHER for p in others},
    }


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
