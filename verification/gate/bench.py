"""Memory and speed out of the files of several processes of `sandglass bench --json`.

Ratios are of the best times of one process each, in which all variants were timed in turn: what disturbs
a batch makes it slower, so that the best is what moves least on a busy machine. Over processes, each of
which lies elsewhere in memory, a ratio becomes an interval.
"""

from .files import InputError, read_json
from .interval import Interval
from .records import Record, entries_of, unique

YARDSTICK = "tl-perturbation"
TWINS = {  # Updated Lagrangian methods and the same control in Total Lagrangian form
    "ul-assumed-strain": "tl-assumed-strain",
    "ul-enhanced": "tl-enhanced",
}
REQUIRED = {"case": str, "elements": int, "method": str, "kernel": str, "precision": str}
REQUIRED |= {"threads": int, "status": str}
FIGURES = ("ns_best", "bytes_per_element_step", "operations_per_element_step", "force_difference")


def _machine(path, document):
    """What times depend on besides the code: processor, compiler, flags."""
    keys = ("processor", "compiler", "build_flags")
    for key in keys:
        if not isinstance(document.get(key), str):
            raise InputError(f"{path}: {key} = {document.get(key)!r}: a text is required")
    return "; ".join(document[key] for key in keys)


def _variants(path, document):
    """The timed entries by variant: case, elements, method, kernel, precision, threads."""
    variants = {}
    for number, entry in enumerate(entries_of(path, document, "records", REQUIRED)):
        if entry["status"].startswith("left out"):
            continue
        variant = tuple(entry[key] for key in list(REQUIRED)[:-1])
        if entry["status"] != "ok":
            variants[variant] = None
            continue
        for key in FIGURES:
            value = entry.get(key)
            if not isinstance(value, (int, float)) or isinstance(value, bool):
                rule = "a number is required"
                raise InputError(f"{path}: records {number}: {key} = {value!r}: {rule}")
        if entry["ns_best"] <= 0.0:
            raise InputError(
                f"{path}: records {number}: ns_best = {entry['ns_best']}: > 0 is required"
            )
        variants[variant] = entry
    return variants


def _name(variant):
    """A variant as it is shown."""
    case, elements, method, kernel, precision, threads = variant
    return f"{case} of {elements}, {method}, {kernel} {precision}, {threads} threads"


def _ratios(variant, variants, document):
    """The ratios of a timed variant to others of its process, by name."""
    case, elements, method, kernel, precision, threads = variant
    time = variants[variant]["ns_best"]
    ratios = {}

    def over(name, method, kernel=kernel, precision=precision):
        other = variants.get((case, elements, method, kernel, precision, threads))
        if other:
            ratios[name] = time / other["ns_best"]

    if method != YARDSTICK:
        over(f"over {YARDSTICK}", YARDSTICK)
        if method in TWINS:
            over(f"over {TWINS[method]}", TWINS[method])
        return ratios
    # The yardstick itself is held against its own plain numbers and against the processor's peak.
    if (kernel, precision) != ("scalar", "double"):
        over("over plain numbers", method, "scalar", "double")
    peak = document.get("peak_gflops", {}).get(precision, {}).get(str(threads))
    if peak:
        at_peak = variants[variant]["operations_per_element_step"] / peak
        ratios["over the time at peak"] = time / at_peak
    return ratios


def read_bench(paths):
    """Records of memory, speed and bits, the machine, and the first document.

    Raises InputError, also when the processes are not of one program on one machine.
    """
    documents = [read_json(path) for path in paths]
    origins = {(_machine(p, d), d.get("revision")) for p, d in zip(paths, documents)}
    if len(origins) > 1:
        told = " and ".join(sorted(f"'{machine}' at {revision}" for machine, revision in origins))
        raise InputError(
            f"{paths[0]} and others: {told}: one machine and one revision are required"
        )
    machine = origins.pop()[0]
    entries, ratios = {}, {}
    for path, document in zip(paths, documents):
        variants = _variants(path, document)
        for variant, entry in variants.items():
            entries.setdefault(variant, []).append(entry)
            if entry:
                for figure, ratio in _ratios(variant, variants, document).items():
                    ratios.setdefault(variant, {}).setdefault(figure, []).append(ratio)
    records = []
    for variant, found in entries.items():
        name = _name(variant)
        records.append(_forces(variant, name, found, machine))
        if None in found:  # no step to look at
            continue
        # Where processes differ, their worst is told.
        memory = {"bytes": max(entry["bytes_per_element_step"] for entry in found)}
        allocations = [entry.get("allocations_per_step") for entry in found]
        if None not in allocations:
            memory["allocations"] = max(allocations)
        records.append(Record("memory", name, memory))
        intervals = {name: Interval.of(samples) for name, samples in ratios[variant].items()}
        trend = {"trend ns": min(entry["ns_best"] for entry in found)}
        records.append(Record("speed", name, intervals | trend))
    return unique(paths[0], records), machine, documents[0]


def _forces(variant, name, found, machine):
    """Whether forces were right: within their limit, and without contraction to the bit for packs of doubles."""
    differs = ""
    if None in found:
        differs = "forces are not those of the scalar double kernel"
    elif "strict-fp ON" in machine and variant[4] == "double":
        largest = max(entry["force_difference"] for entry in found)
        differs = f"forces differ by {largest:.1e} of the largest" if largest > 0.0 else ""
    return Record("forces", name, {"differs": differs})
