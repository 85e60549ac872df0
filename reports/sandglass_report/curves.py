"""Error against cost of a step: fixed methods as points, adaptive ones as lines."""

import json
from pathlib import Path

from sandglass_report import style
from sandglass_report.errors import ReportError
from sandglass_report.plates import MUTED, Panel, Plate

UNIT = "tl-perturbation"  # whose step at kappa auto is the unit of cost
LIMIT = 0.0034  # the paper's error on its profile line


def read_rungs(paths):
    """Case -> rungs of files of `sandglass choose --all --json`. Raises ReportError."""
    cases = {}
    for path in paths:
        try:
            document = json.loads(Path(path).read_text())
            rungs = [r for r in document["rungs"] if _is_shown(r)]
            unit = next(r["seconds"] for r in rungs if r["method"] == UNIT)
            known = cases.setdefault(document["case"], {})
            for rung in rungs:
                known.setdefault(rung["rung"], rung | {"cost": rung["seconds"] / unit})
        except StopIteration:
            raise ReportError(f"{path}: has no step of {UNIT}, the unit of cost") from None
        except (OSError, ValueError, KeyError, TypeError) as error:
            message = f"{path}: not a file of sandglass choose --json: {error!r}"
            raise ReportError(message) from error
    return {case: list(rungs.values()) for case, rungs in cases.items()}


def _is_shown(rung):
    """Steps in double on the user's own mesh that have an answer, with the strength a user gets."""
    own = rung["precision"] == "double" and rung["mesh"] == "own mesh" and rung["kappa"] is None
    return own and rung["seconds"] and rung["step_size"] and rung["error"] is not None


def curve_plate(cases):
    """A plate with one panel for each case."""
    methods = dict.fromkeys(rung["method"] for rungs in cases.values() for rung in rungs)
    palette = style.Palette(dict.fromkeys((*style.solver_methods(), *methods)))
    panels = tuple(_panel(case, rungs, palette) for case, rungs in cases.items())
    legend = tuple((m, palette.colour(m), palette.mark(m)) for m in methods)
    note = (
        "Largest error over all nodes against the mixed reference on the same mesh, over the "
        f"cost of a step under the full load, in steps of {UNIT}; double, one thread. The line is "
        "the adaptive "
        f"method from loose to strict accuracy; the dashed line is {style.exact_percent(LIMIT)}."
    )
    return Plate("adaptive", "How much accuracy for how much time", panels, 2, note, legend)


def _panel(case, rungs, palette):
    adaptive = sorted((r for r in rungs if r.get("accuracy")), key=lambda r: -r["accuracy"])
    fixed = [r for r in rungs if not r.get("accuracy")]

    def draw(axes):
        for rung in fixed:
            where = rung["cost"], max(rung["error"], style.FLOOR)
            method = rung["method"]
            axes.plot(*where, palette.mark(method), color=palette.colour(method), ms=5)
        if adaptive:
            method = adaptive[0]["method"]
            costs = [r["cost"] for r in adaptive]
            errors = [max(r["error"], style.FLOOR) for r in adaptive]
            axes.plot(costs, errors, "-", color=palette.colour(method), lw=1.4, zorder=3)
            axes.plot(
                costs, errors, palette.mark(method), color=palette.colour(method), ms=4, zorder=3
            )
        axes.axhline(LIMIT, color=MUTED, lw=0.8, ls="--")
        axes.set_xscale("log")
        axes.set_yscale("log")
        ticks = [1, 1.5, 2, 3, 5, 8]
        axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
        axes.set_xlabel(f"cost of a step over {UNIT}")
        axes.set_ylabel("max error, all nodes")
        axes.yaxis.set_major_formatter(lambda y, _: f"{100 * y:g} %")

    words = ", ".join(f"{100 * r['error']:.3g} % at {r['cost']:.2f}" for r in adaptive)
    return Panel(
        f"adaptive.{case}", case, f"{case}: adaptive errors and costs: {words}", draw, 400, 320
    )
