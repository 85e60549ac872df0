"""What elements and hourglass controls do to an identified stiffness."""

from matplotlib.ticker import FuncFormatter

from common.errors import InputError
from common.files import read_json
from common.records import NUMBER, entries, entry
from sandglass_report.plates import MUTED, Panel, Plate

LOWEST, HIGHEST = -0.6, 0.15  # of the axis; biases beyond are drawn as arrowheads
PROGRAM = "bench/identified_stiffness.py --json"


def read_identified(path):
    """The records of `bench/identified_stiffness.py --json`. Raises InputError."""
    records = []
    for where, found in entries(path, read_json(path, PROGRAM), "records"):
        for key, kind in {"scene": str, "method": str, "elements": list}.items():
            entry(where, found, key, kind)
        for key in ("kappa", "bias"):
            entry(where, found, key, NUMBER, none_allowed=True)
        if len(found["elements"]) != 3:
            raise InputError(f"{where}.elements = {found['elements']!r} must be three numbers")
        records.append(found)
    return records


def identified_plate(records, palette):
    """A plate with two panels for each scene: the bias over the mesh, and over kappa."""
    records = [found for found in records if palette.knows(found["method"])]
    panels = []
    for scene in dict.fromkeys(found["scene"] for found in records):
        own = [found for found in records if found["scene"] == scene and found["bias"] is not None]
        panels += [_over_meshes(scene, own, palette), _over_kappa(scene, own)]
    methods = dict.fromkeys(found["method"] for found in records if found["kappa"] is None)
    legend = tuple((m, palette.colour(m), palette.mark(m)) for m in methods)
    note = (
        "Identified over true Young's modulus, minus one, without noise. "
        "Arrowheads: beyond the axis. Over kappa: tl-perturbation, darker on finer meshes."
    )
    return Plate("identified", "Bias of an identified stiffness", tuple(panels), 2, note, legend)


def _points(axes, x, records, **line):
    """Biases over x, those beyond the axis as arrowheads at its ends."""
    y = [min(max(found["bias"], LOWEST), HIGHEST) for found in records]
    axes.plot(x, y, **line)
    for mark, end in (("v", LOWEST), ("^", HIGHEST)):
        beyond = [at for at, value in zip(x, y) if value == end]
        axes.plot(beyond, [end] * len(beyond), mark, color=line["color"], ms=7, mew=0)


def _finish(axes):
    axes.axhline(0, color=MUTED, lw=0.9, ls="--")
    axes.set_ylim(LOWEST - 0.02, HIGHEST + 0.02)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:.0f} %"))
    axes.set_ylabel("bias of Young's modulus")


def _over_meshes(scene, records, palette):
    own = [found for found in records if found["kappa"] is None]
    meshes = sorted({tuple(found["elements"]) for found in own})

    def draw(axes):
        for method in dict.fromkeys(found["method"] for found in own):
            row = sorted((f for f in own if f["method"] == method), key=lambda f: f["elements"])
            x = [meshes.index(tuple(found["elements"])) for found in row]
            strokes = {"color": palette.colour(method), "marker": palette.mark(method)}
            _points(axes, x, row, lw=1.0, ms=4, mew=0, **strokes)
        axes.set_xticks(range(len(meshes)), [" × ".join(map(str, mesh)) for mesh in meshes])
        _finish(axes)

    finest = [f for f in own if tuple(f["elements"]) == meshes[-1]]
    words = ", ".join(f"{found['method']} {100 * found['bias']:+.1f} %" for found in finest)
    title = f"{scene}: over the mesh"
    return Panel(f"identified.{_name(scene)}.meshes", title, f"{title}. {words}", draw, 420, 340)


def _over_kappa(scene, records):
    own = [found for found in records if found["kappa"] is not None]
    meshes = sorted({tuple(found["elements"]) for found in own})

    def draw(axes):
        for number, mesh in enumerate(meshes):
            row = sorted((f for f in own if tuple(f["elements"]) == mesh), key=lambda f: f["kappa"])
            shade = {"color": "#0072b2", "alpha": (number + 1) / len(meshes)}
            _points(axes, [f["kappa"] for f in row], row, marker="o", lw=1.2, ms=4, mew=0, **shade)
        axes.set_xscale("log")
        axes.set_xlabel("kappa")
        _finish(axes)

    words = ", ".join(f"{f['kappa']:g}: {100 * f['bias']:+.1f} %" for f in own)
    title = f"{scene}: over kappa"
    return Panel(f"identified.{_name(scene)}.kappa", title, f"{title}. {words}", draw, 420, 340)


def _name(scene):
    return scene.replace(" ", "-")
