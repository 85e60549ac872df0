"""Error against cost of static contact, over methods, meshes and the penalty."""

from common.errors import InputError
from common.files import read_json
from common.records import NUMBER, entries, entry
from sandglass_report.axes import log_scale, percent_scale
from sandglass_report.plates import MUTED, Panel, Plate

PROGRAM = "bench/contact_cost.py --json"
GIGA = 1e9
FLOOR = 1e-3  # smaller errors are drawn here: forces pass Hertz's, and the block is no half-space
SHADES = ("#9ecae1", "#4292c6", "#08306b")  # of meshes, darker on finer ones


def read_contact(path):
    """The records of `bench/contact_cost.py --json` that have an answer. Raises InputError."""
    records = []
    for where, found in entries(path, read_json(path, PROGRAM), "records"):
        entry(where, found, "method", str)
        entry(where, found, "across", int)
        for key in ("penalty", "operations", "error"):
            entry(where, found, key, NUMBER, none_allowed=True)
        if (found["operations"] is None) != (found["error"] is None):
            raise InputError(f"{where}: operations and error must both be numbers, or both null")
        if found["error"] is not None:
            records.append(found)
    return records


def contact_plate(records, palette):
    """A plate with two panels: error over cost of all methods, and over the penalty."""
    plain = [f for f in records if f["penalty"] is None and palette.knows(f["method"])]
    methods = dict.fromkeys(found["method"] for found in plain)
    legend = tuple((m, palette.colour(m), palette.mark(m)) for m in methods)
    panels = _over_cost(plain, methods, palette), _over_penalty(records)
    meshes = ", ".join(map(str, sorted({found["across"] for found in plain})))
    note = (
        "A rigid ball pressed into a block: error of the force against Hertz. Cost: evaluations to "
        "static equilibrium times counted operations of the elements’ forces. Lines join "
        f"{meshes} elements across the contact, or penalties: tl-perturbation, darker on finer "
        "meshes. Errors below 0.1 % are drawn at 0.1 %: the force crosses Hertz’s value as meshes "
        "become finer, and the block is not a half-space."
    )
    return Plate("contact", "Error against cost of contact", panels, 2, note, legend)


def _around(values):
    values = [value for value in values if value > 0]
    return min(values) / 1.5, max(values) * 1.5


def _row(records, by, **own):
    row = [f for f in records if own.items() <= f.items()]
    return sorted(row, key=lambda found: found[by])


def _over_cost(records, methods, palette):
    def draw(axes):
        for method in methods:
            row = _row(records, "across", method=method)
            x = [found["operations"] / GIGA for found in row]
            y = [max(found["error"], FLOOR) for found in row]
            strokes = {"color": palette.colour(method), "marker": palette.mark(method)}
            axes.plot(x, y, lw=1.0, ms=4, mew=0, **strokes)
        log_scale(axes.xaxis, _around(found["operations"] / GIGA for found in records))
        percent_scale(axes.yaxis, _around(max(found["error"], FLOOR) for found in records))
        axes.set_xlabel("cost, billions of operations")
        axes.set_ylabel("error of the force")

    finest = max((found["across"] for found in records), default=0)
    words = ", ".join(
        f"{f['method']} {100 * f['error']:.2g} % for {f['operations'] / GIGA:.2g}"
        for f in records
        if f["across"] == finest
    )
    title = "Methods and meshes"
    return Panel("contact.methods", title, f"{title}. {finest} across: {words}", draw, 420, 340)


def _over_penalty(records):
    varied = [found for found in records if found["penalty"] is not None]
    meshes = sorted({found["across"] for found in varied})

    def draw(axes):
        for number, across in enumerate(meshes):
            row = _row(varied, "penalty", across=across)
            colour = SHADES[min(number, len(SHADES) - 1)]
            x = [found["operations"] / GIGA for found in row]
            y = [max(found["error"], FLOOR) for found in row]
            axes.plot(x, y, color=colour, marker="o", lw=1.0, ms=4, mew=0)
            for found in row[:: max(1, len(row) - 1)]:  # both ends
                place = found["operations"] / GIGA, max(found["error"], FLOOR)
                words = f"{found['penalty']:g}"
                axes.annotate(
                    words, place, (4, 4), textcoords="offset points", size=7.5, color=MUTED
                )
        log_scale(axes.xaxis, _around(found["operations"] / GIGA for found in varied))
        percent_scale(axes.yaxis, _around(max(found["error"], FLOOR) for found in varied))
        axes.set_xlabel("cost, billions of operations")
        axes.set_ylabel("error of the force")

    words = ", ".join(
        f"{f['penalty']:g} on {f['across']}: "
        f"{100 * f['error']:.2g} % for {f['operations'] / GIGA:.2g}"
        for f in varied
    )
    title = "Penalty"
    return Panel("contact.penalty", title, f"{title}. {words}", draw, 420, 340)
