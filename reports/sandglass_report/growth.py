"""The growth of an answer's cost with the mesh, and as Poisson's ratio nears one half."""

from common.errors import InputError
from common.files import read_json
from common.records import NUMBER, entries, entry
from sandglass_report.plates import Panel, Plate

COLOURS = {
    "tl-mean-dilatation": "#2f6fb2",
    "tl-perturbation": "#2a9d5c",
    "FEniCSx": "#c8553d",
    "CalculiX": "#8a6fb0",
}
LINES = {0.3: ":", 0.49: "-", 0.4999: "--"}
KEYS = {"poisson_ratio": NUMBER, "elements": int, "name": str, "seconds": NUMBER}

COUNTS = ("evaluations", "iterations")  # of Sandglass; of Newton's method


def read_growth(path):
    """The records of `bench/growth.py --json`. Raises InputError."""
    records = []
    for where, found in entries(path, read_json(path, "bench/growth.py --json"), "records"):
        for key, kind in KEYS.items():
            entry(where, found, key, kind)
        counts = [entry(where, found, key, int, none_allowed=True) for key in COUNTS]
        if counts.count(None) != 1:
            raise InputError(f"{where}: must have one of {' and '.join(COUNTS)}")
        if found["name"] not in COLOURS or found["poisson_ratio"] not in LINES:
            raise InputError(f"{where}: was not written by bench/growth.py")
        records.append(found)
    return records


def _count(found):
    """The evaluations of a record, or the iterations if it has none."""
    return next(found[key] for key in COUNTS if found[key] is not None)


def growth_plate(records):
    """A plate of seconds, and of evaluations or iterations, over the number of elements."""
    lines = {}
    for found in records:
        lines.setdefault((found["name"], found["poisson_ratio"]), []).append(found)

    def panel(key, value, title, words):
        def draw(axes):
            for (name, ratio), points in lines.items():
                points = sorted(points, key=lambda point: point["elements"])
                axes.plot(
                    [point["elements"] for point in points],
                    [value(point) for point in points],
                    LINES[ratio],
                    color=COLOURS[name],
                    marker="o",
                    ms=3,
                    lw=1.2,
                )
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_xlabel("elements")
            axes.set_ylabel(words)

        largest = max(records, key=lambda found: found["elements"])
        alt = f"{title}: {value(largest):.3g} for {largest['elements']} elements"
        return Panel(f"growth.{key}", title, alt, draw, 420, 320)

    panels = (
        panel("seconds", lambda point: point["seconds"], "Seconds to equilibrium", "wall time, s"),
        panel(
            "work", _count, "Evaluations or iterations to equilibrium", "evaluations or iterations"
        ),
    )
    note = (
        "A bent beam on ever finer meshes, one thread. Poisson's ratio: "
        "0.3 dotted, 0.49 solid, 0.4999 dashed. Sandglass: evaluations of the forces, each "
        "with a multigrid cycle; FEniCSx and CalculiX: Newton iterations, each with a "
        "factorisation."
    )
    names = dict.fromkeys(name for name, _ in lines)
    legend = tuple((name, COLOURS[name], "o") for name in names)
    return Plate("growth", "How the cost grows", panels, 2, note, legend)
