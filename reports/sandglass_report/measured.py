"""Files of commands other than verify: counts, times, candidates, maps. All may be absent."""

from dataclasses import dataclass
from pathlib import Path

from common.files import read_json
from common.records import NUMBER, as_dataclass, entries, entry, facts, key
from sandglass_report.maps import read_maps

BENCH = "sandglass bench --threads 1 --json build/bench.json"
FLOPS = "sandglass flops --json build/flops.json"
CURVES = "reports/curves"
MAPS = "sandglass stability CASE --json build/stability/CASE.json"

OWN_MESH = "own mesh"
# The reference of `choose` if no stored one is requested: the golden's element.
STAND_IN = "tl-mean-dilatation"
REFERENCE_NAMES = {"golden": "golden", "truth": "truth", STAND_IN: "golden"}


@dataclass(frozen=True)
class Candidate:
    """One row of `sandglass choose --all --json`: a method, a precision and a mesh on a case."""

    case: str
    reference: str  # golden or truth
    stands_in: bool  # the golden's own element stands in for it
    tolerance: float  # as requested, a fraction
    method: str
    kappa: float | None  # None: default
    accuracy: float | None  # requested of an adaptive method, a fraction
    precision: str
    mesh: str
    elements: int
    step_size: float | None  # s, mean of the motion; None where nothing moves
    error: float | None  # largest of all nodes, a fraction of the imposed displacement
    reason: str  # why it is not enough; empty if it is
    step_remark: str  # about steps of single states; mostly empty
    facts: dict  # of its file: machine and revision
    name: str = key("rung")  # of method, kappa or accuracy, precision and mesh
    step: float | None = key("seconds")  # s of wall time
    checks: float | None = key("check_seconds_per_step")  # s of wall time
    simulated: float | None = key("seconds_per_simulated_second")  # s of wall time


@dataclass(frozen=True)
class Step:
    """One record of `sandglass bench --json`: packs on one thread."""

    case: str
    elements: int
    method: str
    precision: str
    ns: float = key("ns_per_element_step")  # median
    mean_step: float | None = key("mean_step_seconds")  # s; None for a box
    simulated: float | None = key("seconds_per_simulated_second")


@dataclass(frozen=True)
class Count:
    """Operations of one part of a method's element and step; `form` is kernel or paper."""

    method: str
    law: str
    form: str
    part: str
    total: int


@dataclass(frozen=True)
class Source:
    """A file that the page reads: the command that makes it, and its metadata."""

    path: str
    command: str
    facts: dict | None  # None: the file is missing


@dataclass(frozen=True)
class Measured:
    """The contents of all files."""

    candidates: tuple = ()
    steps: tuple = ()
    counts: tuple = ()
    maps: tuple = ()  # documents of sandglass stability
    sources: tuple = ()

    def facts_of(self, command):
        """Machine and revision of the file that a command made; empty if it is missing."""
        return next((s.facts or {} for s in self.sources if s.command == command), {})


def read_measured(bench, flops, curves, maps, kept_maps):
    """Measured from two files and three folders of JSON files, each of which may be absent.

    kept_maps: earlier maps, for cases that have none in maps.
    Raises InputError if a file exists but is broken.
    """
    sources = []

    def records(path, command):
        if Path(path).is_file():
            return entries(path, _document(path, command, sources), "records")
        sources.append(Source(str(path), command, None))
        return []

    steps = [as_dataclass(Step, *one) for one in records(bench, BENCH) if _is_step(*one)]
    counts = [as_dataclass(Count, *one) for one in records(flops, FLOPS)]
    candidates = []
    for path in _files(curves, CURVES, sources):
        candidates += candidates_of(path, _document(path, CURVES, sources))
    found = {}
    for path in (*sorted(Path(maps).glob("*.json")), *_files(kept_maps, MAPS, sources)):
        document = read_maps(path)
        if found.setdefault(document["case"], document) is document:
            sources.append(Source(str(path), MAPS, facts(document)))
    return Measured(*map(tuple, (candidates, steps, counts, found.values(), sources)))


def _files(folder, command, sources):
    """The JSON files of a folder; their absence is recorded."""
    found = sorted(Path(folder).glob("*.json"))
    if not found:
        sources.append(Source(f"{folder}/*.json", command, None))
    return found


def _document(path, command, sources):
    """The document of a file, which is recorded as a source."""
    document = read_json(path)
    sources.append(Source(str(path), command, facts(document)))
    return document


def _is_step(where, record):
    """Whether a record of bench is of packs on one thread, and has a time."""
    has_time = entry(where, record, "ns_per_element_step", NUMBER, none_allowed=True) is not None
    on_packs = entry(where, record, "kernel", str) == "pack"
    return has_time and on_packs and entry(where, record, "threads", int) == 1


def candidates_of(path, document):
    """The Candidates of a document of `sandglass choose --all --json`. Raises InputError.

    path: its file, for messages.
    """
    reference = entry(path, document, "reference", dict)
    name = entry(f"{path}: reference", reference, "name", str)
    known = {
        "case": entry(path, document, "case", str),
        "reference": REFERENCE_NAMES.get(name, name),
        "stands_in": name == STAND_IN,
        "tolerance": entry(path, document, "tolerance", NUMBER),
        "facts": facts(document),
    }
    return [as_dataclass(Candidate, *found, **known) for found in entries(path, document, "rungs")]
