"""Memory, forces and speed from the files of several processes of `sandglass bench --json`.

Ratios are of the best times of one process each, in which all variants were timed in turn: what
disturbs a batch makes it slower, so that the best is what moves least on a busy machine. Over
processes, each of which lies elsewhere in memory, a ratio becomes an interval.
"""

import math

from common.errors import InputError
from common.files import read_json
from common.records import NUMBER, entry

from .interval import Interval
from .records import Record, entries_of, machine_of, unique

# A method is compared with the geometric mean of these, excluding itself: the time of a single
# method is too noisy, and that method could not be compared itself.
PACEMAKERS = (
    "linear",
    "tl-assumed-strain",
    "tl-energy-sampling",
    "tl-enhanced",
    "tl-modal-sampling",
    "tl-none",
    "tl-perturbation",
    "tl-stabilization-matrix",
)
# Not a step but a matrix product: 3.0 or 3.6 ns depending on its placement in memory. A trend.
UNSTEADY = ("linear-condensed",)
TWINS = {  # Updated Lagrangian methods and the same control in Total Lagrangian form
    "ul-assumed-strain": "tl-assumed-strain",
    "ul-enhanced": "tl-enhanced",
    "ul-perturbation": "tl-perturbation",
}
REQUIRED = {"case": str, "elements": int, "method": str, "kernel": str, "precision": str}
REQUIRED |= {"threads": int, "status": str}
FIGURES = ("ns_best", "bytes_per_element_step")


def _variants(path, document):
    """The timed entries by variant: case, elements, method, kernel, precision, threads."""
    variants = {}
    for where, timed in entries_of(path, document, "records", REQUIRED):
        if timed["status"].startswith("left out"):
            continue
        variant = tuple(timed[key] for key in list(REQUIRED)[:-1])
        if timed["status"] != "ok":
            variants[variant] = None
            continue
        for key in FIGURES:
            entry(where, timed, key, NUMBER)
        if timed["ns_best"] <= 0.0:
            raise InputError(f"{where}.ns_best = {timed['ns_best']} must be > 0")
        variants[variant] = timed
    return variants


def _name(variant):
    """A variant as text."""
    case, elements, method, kernel, precision, threads = variant
    unit = "thread" if threads == 1 else "threads"
    return f"{case} of {elements}, {method}, {kernel} {precision}, {threads} {unit}"


def _with(variant, **changed):
    """A variant that differs in method, kernel or precision."""
    return tuple(changed.get(key, value) for key, value in zip(REQUIRED, variant))


def _pace(variant, variants):
    """The geometric mean time of the other pacemakers, ns; None if one has no time."""
    makers = [
        variants.get(_with(variant, method=name)) for name in PACEMAKERS if name != variant[2]
    ]
    if not all(makers):
        return None
    return math.exp(math.fsum(math.log(maker["ns_best"]) for maker in makers) / len(makers))


def _ratios_of_all(variant, variants, document):
    """Ratios of the overall pace: to the processor's peak, and of packs to plain numbers."""
    variant = _with(variant, method="pace")
    pace, ratios = _pace(variant, variants), {}
    peak = document.get("peak_gflops", {}).get(variant[4], {}).get(str(variant[5]))
    if pace and peak:
        ratios["ns at peak flops"] = pace * peak
    plain = _pace(_with(variant, kernel="scalar", precision="double"), variants)
    if pace and plain and variant[3:5] != ("scalar", "double"):
        ratios["over plain numbers"] = pace / plain
    return variant, ratios


def _ratios(variants, document):
    """The ratios of one process: by variant, then by name."""
    ratios = {}
    for variant, timed in variants.items():
        if timed is None or variant[2] in UNSTEADY:
            continue
        of_variant = ratios.setdefault(variant, {})
        pace = _pace(variant, variants)
        if pace:
            of_variant["over pace"] = timed["ns_best"] / pace
        twin = TWINS.get(variant[2])
        other = variants.get(_with(variant, method=twin))
        if other:
            of_variant[f"over {twin}"] = timed["ns_best"] / other["ns_best"]
        of_all, found = _ratios_of_all(variant, variants, document)
        ratios.setdefault(of_all, {}).update(found)
    return ratios


def read_bench(paths):
    """Records of memory, speed and bits, the machine, and the first document.

    Raises InputError, also when the processes are not of one program on one machine.
    """
    documents = [read_json(path) for path in paths]
    origins = {(machine_of(p, d), d.get("revision")) for p, d in zip(paths, documents)}
    if len(origins) > 1:
        told = " and ".join(sorted(f"'{machine}' at {revision}" for machine, revision in origins))
        raise InputError(f"{paths[0]} and others: {told}; must be of one machine and one revision")
    machine = origins.pop()[0]
    entries, samples = {}, {}
    for path, document in zip(paths, documents):
        variants = _variants(path, document)
        for variant, timed in variants.items():
            entries.setdefault(variant, []).append(timed)
        for variant, ratios in _ratios(variants, document).items():
            for figure, ratio in ratios.items():
                samples.setdefault(variant, {}).setdefault(figure, []).append(ratio)
    records = []
    for variant, found in entries.items():
        records.append(_forces(variant, found))
        if None not in found:
            records.append(_memory(variant, found))
    for variant in dict.fromkeys([*entries, *samples]):
        found = entries.get(variant, ())
        if None in found:  # wrong in one process: no time counts
            continue
        figures = {name: Interval.of(of) for name, of in samples.get(variant, {}).items()}
        if found:
            figures["trend ns"] = min(timed["ns_best"] for timed in found)
        if figures:
            records.append(Record("speed", _name(variant), figures))
    return unique(paths[0], records), machine, documents[0]


def _memory(variant, found):
    """Bytes of a step; the most, if processes differ."""
    most = max(timed["bytes_per_element_step"] for timed in found)
    return Record("memory", _name(variant), {"bytes": most})


def _forces(variant, found):
    """Whether forces were those of the scalar double kernel, within the limit that bench sets.

    More is promised of single elements in strict-fp builds, where tests hold it: on meshes packs
    and plain numbers add at nodes in another order.
    """
    differs = "forces are not those of the scalar double kernel" if None in found else ""
    return Record("forces", _name(variant), {"differs": differs})
