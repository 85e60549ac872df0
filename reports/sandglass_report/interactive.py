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


def chart_data(points, palette):
    """The data for chart.js: points, fronts, adaptive lines, and the methods' colours and marks."""
    return {
        "own_mesh": OWN_MESH,
        "points": [p.as_record() | {"fails": not p.ok or p.finding in FAILURES} for p in points],
        "fronts": fronts(points),
        "families": families(points),
        "methods": {
            m: {"css": palette.css(m), "symbol": style.PLOTLY_MARKS[palette.mark(m)]}
            for m in palette.methods
        },
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
