"""Figures by area and name, read from the JSON files of the program's commands."""

from dataclasses import dataclass, field

from common.errors import InputError
from common.files import read_json
from common.records import entries, entry

# The areas of figures. Those of the last two apply to one machine only, and those of the first may
# differ on another: instruction sets round differently, and adaptivity raises whole packs.
AREAS = ("accuracy", "operations", "bits", "forces", "memory", "speed")
OF_MACHINE = ("memory", "speed")
MAY_DIFFER = ("accuracy",)
ORIGIN = ("processor", "compiler", "build_flags")


@dataclass(frozen=True)
class Record:
    """Figures of one thing. A figure is a number, a text or, for speed, an Interval."""

    area: str
    name: str
    figures: dict


@dataclass
class Run:
    """The figures found by one run of the gate."""

    records: list = field(default_factory=list)
    revision: str | None = None
    machine: str | None = None  # see machine_of; None if no file states it

    def add(self, path, records, document):
        """Adds the records of a file. Raises InputError if of another program or machine."""
        machine = machine_of(path, document) if "processor" in document else None
        self.revision = _agreed(path, "revision", document.get("revision"), self.revision)
        self.machine = _agreed(path, "machine", machine, self.machine)
        self.records = unique(path, self.records + records)


def machine_of(path, document):
    """All that bytes and times depend on besides the code: processor, compiler, flags."""
    return "; ".join(entry(path, document, key, str) for key in ORIGIN)


def _agreed(path, what, found, known):
    """The common value stated by one file and by others, either None. Raises InputError."""
    if found and known not in (found, None):
        raise InputError(f"{path}: {what} = {found!r} must be {known!r}, as of the others")
    return found or known


def entries_of(path, document, key, required):
    """(where, object) of a list of a document, each with the required keys and kinds."""
    found = entries(path, document, key)
    for where, one in found:
        for name, kind in required.items():
            entry(where, one, name, kind)
    return found


def unique(path, records):
    """The records, whose names must be unique. Raises InputError."""
    seen = set()
    for record in records:
        if (record.area, record.name) in seen:
            raise InputError(
                f"{path}: {record.area}: '{record.name}' is there twice; once is allowed"
            )
        seen.add((record.area, record.name))
    return records


def _errors(verdict):
    """The accuracy figures of a verdict by name: fractions of the largest imposed displacement."""
    figures = {}
    for reference in ("golden", "truth"):
        for key, value in (verdict.get(reference) or {}).items():
            if value is not None:
                figures[f"{reference} {key.removesuffix('_relative_error')}"] = value
    for value in verdict.get("values", []):
        if value.get("ratio") is not None:
            figures[f"published {value['set']} {value['component']}"] = abs(value["ratio"] - 1.0)
    return figures


def read_verdicts(path):
    """Records of accuracy and their document, of `sandglass verify --json`. Raises InputError."""
    document = read_json(path)
    required = {"case": str, "method": str, "precision": str, "status": str}
    records = []
    for key in ("records", "published"):
        for _, one in entries_of(path, document, key, required):
            kappa = one.get("kappa")
            if kappa is not None:
                kappa = "auto" if one.get("kappa_is_auto") else f"{kappa:g}"
            parts = (one["case"], one["method"], kappa and f"kappa {kappa}", one["precision"])
            # The point where a failed run stopped is arbitrary.
            ok = one["status"] == "ok"
            figures = {"status": "ok", **_errors(one)} if ok else {"status": "failed"}
            records.append(Record("accuracy", ", ".join(filter(None, parts)), figures))
    return unique(path, records), document


def read_flops(path):
    """Records of operations and their document, of `sandglass flops --json`. Raises InputError."""
    document = read_json(path)
    counts = ("add", "mul", "div", "special", "bytes")
    required = {"method": str, "law": str, "form": str, "part": str} | dict.fromkeys(counts, int)
    records = []
    for _, one in entries_of(path, document, "records", required):
        name = ", ".join(one[key] for key in ("method", "law", "form", "part"))
        records.append(Record("operations", name, {count: one[count] for count in counts}))
    # A law's table repeats parts of the method with which it was counted.
    return unique(path, list({(r.area, r.name): r for r in records}.values())), document


def read_bits(path):
    """Records of bits and their document, as collect.py writes them. Raises InputError."""
    document = read_json(path)
    records = []
    for _, one in entries_of(path, document, "records", {"name": str, "differs": str}):
        records.append(Record("bits", one["name"], {"differs": one["differs"]}))
    return unique(path, records), document
