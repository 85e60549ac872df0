"""Error to the truth over time, on meshes refined where the answer needs it and on others."""

from common.errors import InputError
from common.files import read_json
from common.records import NUMBER, entries, entry
from sandglass_report.plates import Panel, Plate

REST = 1e-8  # the residual of cases
LINES = {  # (way, whether at rest) -> what it is called, its colour and its line
    ("uniform", True): ("all elements split, at rest", "#c8553d", "-"),
    ("uniform", False): ("all elements split, to a residual of .001", "#c8553d", ":"),
    ("refined", False): ("refined where the answer needs it", "#2f6fb2", "-"),
}


def read_refinement(path):
    """The records of `bench/refinement.py --json`. Raises InputError."""
    records = []
    for where, found in entries(path, read_json(path, "bench/refinement.py --json"), "records"):
        for key, kind in (
            ("case", str),
            ("way", str),
            ("elements", int),
            ("seconds", NUMBER),
            ("error_max", NUMBER),
            ("error_rms", NUMBER),
        ):
            entry(where, found, key, kind)
        if line_of(found) not in LINES:
            raise InputError(f"{where}: is not of bench/refinement.py")
        records.append(found)
    return records


def line_of(record):
    """The line that a record is a point of, a key of LINES."""
    return record["way"], record["way"] == "uniform" and record.get("residual") == REST


def refinement_plate(records):
    """A plate with a panel for each case: largest error over seconds."""

    def panel(name):
        points = [found for found in records if found["case"] == name]

        def draw(axes):
            for line, (_, colour, style) in LINES.items():
                on_it = sorted((p["seconds"], p["error_max"]) for p in points if line_of(p) == line)
                x, y = [seconds for seconds, _ in on_it], [100 * error for _, error in on_it]
                axes.plot(x, y, style, color=colour, marker="o", ms=3, lw=1.2)
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_xlabel("s")
            axes.set_ylabel("largest error, %")

        best = {
            way: min((p for p in points if p["way"] == way), key=lambda p: p["error_max"])
            for way in dict.fromkeys(p["way"] for p in points)
        }
        told = ", ".join(
            f"{way}: {100 * p['error_max']:.2g} % in {p['seconds']:.2g} s"
            for way, p in best.items()
        )
        return Panel(f"refinement.{name}", name, f"{name}: {told}", draw, 420, 320)

    names = dict.fromkeys(found["case"] for found in records)
    note = (
        "tl-mean-dilatation, one thread, from the model on. Distance from the truth at the worst "
        "node of the case's own mesh, over the imposed displacement."
    )
    legend = tuple((words, colour, "o") for words, colour, _ in LINES.values())
    panels = tuple(panel(name) for name in names)
    return Plate("refinement", "Error to the truth over time", panels, 2, note, legend)
