"""Error to the truth over time, on adaptively refined meshes and on uniform ones."""

from common.errors import InputError
from common.files import read_json
from common.records import NUMBER, entries, entry
from sandglass_report.axes import log_scale, percent_scale
from sandglass_report.plates import Panel, Plate

REST = 1e-8  # the residual of cases
KEYS = {"case": str, "way": str, "elements": int}
KEYS |= dict.fromkeys(("seconds", "error_max", "error_rms"), NUMBER)
LINES = {  # (way, whether solved to REST) -> its name, colour and line
    ("uniform", True): ("all split, residual 1e-8", "#c8553d", "-"),
    ("uniform", False): ("all split, residual 1e-3", "#e3a78f", ":"),
    ("refined", False): ("refined", "#2f6fb2", "-"),
}


def read_refinement(path):
    """The records of `bench/refinement.py --json`. Raises InputError."""
    records = []
    for where, found in entries(path, read_json(path, "bench/refinement.py --json"), "records"):
        for key, kind in KEYS.items():
            entry(where, found, key, kind)
        if line_of(found) not in LINES:
            raise InputError(f"{where}: was not written by bench/refinement.py")
        records.append(found)
    return records


def line_of(record):
    """The line that a record belongs to, a key of LINES."""
    return record["way"], record["way"] == "uniform" and record.get("residual") == REST


def fastest(records):
    """The fastest record on each mesh, in the order of their elements."""
    found = {}
    for record in sorted(records, key=lambda one: (one["elements"], one["seconds"])):
        found.setdefault(record["elements"], record)
    return list(found.values())


def around(values):
    """Limits of an axis for some values > 0."""
    values = list(values)
    return min(values) / 1.4, max(values) * 1.4


def refinement_plate(records):
    """A plate with a panel for each case: largest error over seconds."""

    def panel(name):
        points = [found for found in records if found["case"] == name]

        def draw(axes):
            for line, (_, colour, style) in LINES.items():
                on_it = fastest(found for found in points if line_of(found) == line)
                x = [found["seconds"] for found in on_it]
                y = [found["error_max"] for found in on_it]
                axes.plot(x, y, style, color=colour, marker="o", ms=3, lw=1.2)
            log_scale(axes.xaxis, around(found["seconds"] for found in points))
            percent_scale(axes.yaxis, around(found["error_max"] for found in points))
            axes.set_xlabel("wall time, s")
            axes.set_ylabel("largest error to the truth")

        best = {
            way: min((p for p in points if p["way"] == way), key=lambda p: p["error_max"])
            for way in dict.fromkeys(p["way"] for p in points)
        }
        text = ", ".join(
            f"{way}: {100 * p['error_max']:.2g} % in {p['seconds']:.2g} s"
            for way, p in best.items()
        )
        return Panel(f"refinement.{name}", name, f"{name}: {text}", draw, 420, 320)

    names = dict.fromkeys(found["case"] for found in records)
    note = (
        "tl-mean-dilatation, one thread. Distance from the truth at the worst "
        "node of the case's own mesh, over the imposed displacement. All elements split 0, 1, 2 "
        "times, solved to a residual of 1e-8 or 1e-3; and refined where the answer needs it."
    )
    legend = tuple((words, colour, "o") for words, colour, _ in LINES.values())
    panels = tuple(panel(name) for name in names)
    return Plate("refinement", "Error to the truth over time", panels, 2, note, legend)
