"""What other commands than verify leave: counts, times, ladders, maps. All may be absent."""

from dataclasses import dataclass
from pathlib import Path

from sandglass_report.checks import NUMBER, entries, entry, facts, read_document
from sandglass_report.maps import read_maps

BENCH = "sandglass bench --threads 1 --json build/bench.json"
FLOPS = "sandglass flops --json build/flops.json"
REST = "sandglass bench --rest --json build/rest.json"
CURVES = "ci/curves"
MAPS = "sandglass stability CASE --json build/stability/CASE.json"

OWN_MESH = "own mesh"
# What `choose` measures against when no stored reference is asked for is the golden's own element.
REFERENCE_NAMES = {"golden": "golden", "truth": "truth", "tl-mean-dilatation": "golden"}


@dataclass(frozen=True)
class Rung:
    """One row of `sandglass choose --all --json`: a method, a precision and a mesh on a case."""

    case: str
    reference: str  # golden or truth
    method: str
    kappa: float | None  # None: as it comes
    accuracy: float | None  # asked of an adaptive method, a fraction
    precision: str
    mesh: str
    elements: int
    step: float | None  # s
    simulated: float | None  # s of wall time for a simulated second
    error: float | None  # largest of all nodes, a fraction of the imposed displacement
    tolerance: float  # that was asked for, a fraction
    reason: str  # why it is not enough for that; empty where it is


@dataclass(frozen=True)
class Step:
    """One record of `sandglass bench --json`: packs on one thread."""

    case: str
    elements: int
    method: str
    precision: str
    ns: float  # per element and step, median
    stable_step: float | None  # s


@dataclass(frozen=True)
class Rest:
    """One record of `sandglass bench --rest --json`; seconds, None when it did not come to rest."""

    case: str
    method: str
    precision: str
    seconds: float | None
    to_1_percent: float | None
    to_0_1_percent: float | None


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
    """A file that the page reads: how it is made, and what it says about its making."""

    path: str
    command: str
    facts: dict | None  # None: the file is not there


@dataclass(frozen=True)
class Measured:
    """All that is there."""

    rungs: tuple = ()
    steps: tuple = ()
    rests: tuple = ()
    counts: tuple = ()
    maps: tuple = ()  # documents of sandglass stability
    sources: tuple = ()


def read_measured(bench, flops, rest, curves, maps, kept_maps):
    """Measured from three files and three folders of JSON files, each of which may be absent.

    kept_maps: earlier maps, which stand in for cases that have none in maps.
    Raises ReportError when one is there and broken.
    """
    sources = []
    steps = _read(bench, BENCH, _steps, sources)
    counts = _read(flops, FLOPS, _counts, sources)
    rests = _read(rest, REST, _rests, sources)
    rungs = [
        rung
        for path in _files(curves, CURVES, sources)
        for rung in _read(path, CURVES, _rungs, sources)
    ]
    found = {}
    for path in (*sorted(Path(maps).glob("*.json")), *_files(kept_maps, MAPS, sources)):
        document = read_maps(path)
        if found.setdefault(document["case"], document) is document:
            sources.append(Source(str(path), MAPS, facts(document)))
    return Measured(*map(tuple, (rungs, steps, rests, counts, found.values(), sources)))


def _files(folder, command, sources):
    """The JSON files of a folder; when there is none, that is noted."""
    found = sorted(Path(folder).glob("*.json"))
    if not found:
        sources.append(Source(f"{folder}/*.json", command, None))
    return found


def _read(path, command, records_of, sources):
    """The records of a file; none when it is absent, which is noted."""
    if not Path(path).is_file():
        sources.append(Source(str(path), command, None))
        return []
    document = read_document(path, command)
    records = records_of(path, document)
    sources.append(Source(str(path), command, facts(document)))
    return records


def _rungs(path, document):
    case = entry(path, document, "case", str)
    name = entry(f"{path}: reference", entry(path, document, "reference", dict), "name", str)
    reference = REFERENCE_NAMES.get(name, name)
    tolerance = entry(path, document, "tolerance", NUMBER)
    return [
        Rung(
            case,
            reference,
            method=entry(where, r, "method", str),
            kappa=entry(where, r, "kappa", NUMBER, True),
            accuracy=entry(where, r, "accuracy", NUMBER, True),
            precision=entry(where, r, "precision", str),
            mesh=entry(where, r, "mesh", str),
            elements=entry(where, r, "elements", int),
            step=entry(where, r, "seconds", NUMBER, True),
            simulated=entry(where, r, "seconds_per_simulated_second", NUMBER, True),
            error=entry(where, r, "error", NUMBER, True),
            tolerance=tolerance,
            reason=entry(where, r, "reason", str),
        )
        for where, r in entries(path, document, "rungs")
    ]


def _steps(path, document):
    found = []
    for where, r in entries(path, document, "records"):
        ns = entry(where, r, "ns_per_element_step", NUMBER, True)
        if entry(where, r, "kernel", str) == "pack" and r.get("threads") == 1 and ns is not None:
            found.append(
                Step(
                    case=entry(where, r, "case", str),
                    elements=entry(where, r, "elements", int),
                    method=entry(where, r, "method", str),
                    precision=entry(where, r, "precision", str),
                    ns=ns,
                    stable_step=entry(where, r, "stable_step_seconds", NUMBER, True),
                )
            )
    return found


def _rests(path, document):
    return [
        Rest(
            case=entry(where, r, "case", str),
            method=entry(where, r, "method", str),
            precision=entry(where, r, "precision", str),
            seconds=entry(where, r, "seconds_to_rest", NUMBER, True),
            to_1_percent=entry(where, r, "seconds_to_1_percent", NUMBER, True),
            to_0_1_percent=entry(where, r, "seconds_to_0_1_percent", NUMBER, True),
        )
        for where, r in entries(path, document, "records")
    ]


def _counts(path, document):
    return [
        Count(
            method=entry(where, r, "method", str),
            law=entry(where, r, "law", str),
            form=entry(where, r, "form", str),
            part=entry(where, r, "part", str),
            total=entry(where, r, "total", int),
        )
        for where, r in entries(path, document, "records")
    ]
