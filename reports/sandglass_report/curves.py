"""Error against cost per step: fixed methods as points, adaptive ones as lines."""

from common.errors import InputError
from common.files import read_json
from sandglass_report import style
from sandglass_report.measured import OWN_MESH, candidates_of
from sandglass_report.plates import MUTED, Panel, Plate

UNIT = "tl-perturbation"  # whose step at kappa auto is the unit of cost
LIMIT = 0.0034  # the paper's error on its profile line


def read_costs(paths):
    """Case -> (cost, Candidate) of files of `sandglass choose --all --json`. Raises InputError.

    cost: of a step, over that of UNIT in the same file. If several files have a candidate, the
    first is used.
    """
    cases = {}
    for path in paths:
        candidates = candidates_of(path, read_json(path, "sandglass choose --all --json"))
        shown = [c for c in candidates if _is_shown(c)]
        unit = next((c.step for c in shown if c.method == UNIT), None)
        if unit is None:
            raise InputError(f"{path}: rungs: must have a step of {UNIT}, the unit of cost")
        for candidate in shown:
            known = cases.setdefault(candidate.case, {})
            known.setdefault(candidate.name, (candidate.step / unit, candidate))
    return {case: list(found.values()) for case, found in cases.items()}


def _is_shown(candidate):
    """Candidates with an answer in double on the user's own mesh, with default kappa."""
    own = candidate.precision == "double" and candidate.mesh == OWN_MESH and candidate.kappa is None
    return own and candidate.step and candidate.step_size and candidate.error is not None


def curve_plate(cases):
    """A plate with one panel for each case. cases: of read_costs()."""
    methods = dict.fromkeys(c.method for found in cases.values() for _, c in found)
    palette = style.Palette(dict.fromkeys((*style.solver_methods(), *methods)))
    panels = tuple(_panel(case, found, palette) for case, found in cases.items())
    legend = tuple((m, palette.colour(m), palette.mark(m)) for m in methods)
    note = (
        "Largest error over all nodes against the mixed reference on the same mesh, over the "
        f"cost of a step under the full load, in steps of {UNIT}; double, one thread. The line is "
        "the adaptive method from loose to strict accuracy; the dashed line is "
        f"{style.exact_percent(LIMIT)}."
    )
    return Plate("adaptive", "Accuracy against time", panels, 2, note, legend)


def _panel(case, found, palette):
    """Errors over costs of one case."""
    adaptive = [(cost, c) for cost, c in found if c.accuracy]
    adaptive.sort(key=lambda one: -one[1].accuracy)

    def draw(axes):
        for cost, candidate in found:
            if not candidate.accuracy:
                colour, mark = palette.colour(candidate.method), palette.mark(candidate.method)
                axes.plot(cost, max(candidate.error, style.FLOOR), mark, color=colour, ms=5)
        if adaptive:
            method = adaptive[0][1].method
            colour, mark = palette.colour(method), palette.mark(method)
            costs = [cost for cost, _ in adaptive]
            errors = [max(c.error, style.FLOOR) for _, c in adaptive]
            axes.plot(costs, errors, f"-{mark}", color=colour, lw=1.4, ms=4, zorder=3)
        axes.axhline(LIMIT, color=MUTED, lw=0.8, ls="--")
        axes.set_xscale("log")
        axes.set_yscale("log")
        ticks = [1, 1.5, 2, 3, 5, 8]
        axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
        axes.set_xlabel(f"cost of a step over {UNIT}")
        axes.set_ylabel("max error, all nodes")
        axes.yaxis.set_major_formatter(lambda y, _: f"{100 * y:g} %")

    words = ", ".join(f"{100 * c.error:.3g} % at {cost:.2f}" for cost, c in adaptive)
    return Panel(
        f"adaptive.{case}", case, f"{case}: adaptive errors and costs: {words}", draw, 400, 320
    )
