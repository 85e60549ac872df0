"""Reading verdicts.json: what ran, how near it came, and which limits hold."""

import json
import math
from dataclasses import dataclass

from sandglass_report.accuracy import Accuracy
from sandglass_report.errors import ReportError

REFERENCES = ("golden", "truth")


@dataclass(frozen=True)
class Run:
    """One method on one case; `golden` and `truth` are its accuracies, None without a figure."""

    case: str
    method: str
    kappa: float | None
    kappa_is_auto: bool
    precision: str
    status: str
    finding: str | None  # how it went wrong, or "good"; None without a golden to tell by
    golden: Accuracy | None
    truth: Accuracy | None
    operations: int  # per element and step
    stable_step: float  # s, at rest
    steps: int
    residual: float
    hourglass_energy_ratio: float  # of the strain energy
    ns_per_element_step: float
    wall_seconds: float

    @property
    def ok(self):
        """Whether the run came to rest."""
        return self.status == "ok"

    @property
    def is_main(self):
        """Whether this is the method as it comes, not a point of its kappa curve."""
        return self.kappa is None or self.kappa_is_auto

    @property
    def label(self):
        """The method's name, with its kappa where it has one."""
        if self.kappa is None:
            return self.method
        return f"{self.method} κ {'auto' if self.kappa_is_auto else f'{self.kappa:g}'}"

    @property
    def file_name(self):
        """Name of the result file that `sandglass verify --results` writes for this run."""
        kappa = "" if self.is_main else f".{self.kappa!r}"
        return f"{self.case}.{self.method}{kappa}.h5"


@dataclass(frozen=True)
class Tip:
    """One method on one variant of a case with a published value; ratios are None without one."""

    family: str
    variant: str
    method: str
    ok: bool
    finding: str
    source: str
    to_published: float | None
    to_truth: float | None


@dataclass(frozen=True)
class Limit:
    """One expectation of a case and what came of it; figures are fractions."""

    case: str
    method: str
    kappa: str
    reference: str
    figure: str
    below: float | None
    above: float | None
    found: float | None
    at_kappa: float | None
    holds: bool
    reason: str


@dataclass(frozen=True)
class Verdicts:
    """The contents of verdicts.json."""

    provenance: dict
    runs: tuple
    limits: tuple
    tips: tuple = ()

    @property
    def case_names(self):
        """Names of the cases, in the order of the file."""
        return tuple(dict.fromkeys(run.case for run in self.runs))

    @property
    def methods(self):
        """Names of the methods, in the order of the file, which is the solver's."""
        return tuple(dict.fromkeys(run.method for run in self.runs))


def read_verdicts(path):
    """Verdicts of a verdicts.json. Raises ReportError when it is missing or not one."""
    try:
        with open(path, encoding="utf-8") as file:
            document = json.load(file)
    except OSError as error:
        raise ReportError(
            f"{path}: cannot read the verdicts: {error.strerror}; make them with "
            f"sandglass verify --json {path} --results FOLDER"
        ) from error
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise ReportError(f"{path}: not a JSON file: {error}") from error
    if not isinstance(document, dict):
        raise ReportError(f"{path}: not the verdicts of sandglass verify: no JSON object")
    runs = tuple(_run(path, i, r) for i, r in enumerate(_list(path, document, "records")))
    if not runs:
        raise ReportError(f"{path}: records is empty: nothing ran, there is nothing to report")
    limits = tuple(_limit(path, i, r) for i, r in enumerate(_list(path, document, "limits")))
    tables = enumerate(document.get("published", []))
    tips = tuple(tip for i, record in tables for tip in _tips(path, i, record))
    provenance = {name: str(v) for name, v in document.items() if not isinstance(v, list)}
    return Verdicts(provenance, runs, limits, tips)


def _list(path, document, key):
    """A required list of the document."""
    if not isinstance(document.get(key), list):
        raise ReportError(f"{path}: {key} is missing or no list: not the verdicts of this solver")
    return document[key]


def _field(where, record, key, kinds, none_allowed=False):
    """A required, checked entry of a record; null where allowed."""
    if not isinstance(record, dict) or key not in record:
        raise ReportError(f"{where}.{key} is missing; the file comes from another version")
    value = record[key]
    if value is None and none_allowed:
        return None
    if not isinstance(value, kinds) or (bool not in _tuple(kinds) and isinstance(value, bool)):
        wanted = " or ".join(kind.__name__ for kind in _tuple(kinds))
        raise ReportError(f"{where}.{key} = {value!r}: must be {wanted}")
    if isinstance(value, float) and not math.isfinite(value):
        raise ReportError(f"{where}.{key} = {value!r}: must be finite")
    return value


def _tuple(kinds):
    return kinds if isinstance(kinds, tuple) else (kinds,)


NUMBER = (int, float)


def _accuracy(where, record, key):
    """The accuracy figures against one reference, or None."""
    figures = _field(where, record, key, dict, none_allowed=True)
    if figures is None:
        return None
    return Accuracy(
        max=_field(f"{where}.{key}", figures, "max_relative_error", NUMBER),
        rms=_field(f"{where}.{key}", figures, "rms_relative_error", NUMBER),
        profile=_field(f"{where}.{key}", figures, "profile_relative_error", NUMBER, True),
    )


def _run(path, index, record):
    where = f"{path}: records[{index}]"
    return Run(
        case=_field(where, record, "case", str),
        method=_field(where, record, "method", str),
        kappa=_field(where, record, "kappa", NUMBER, none_allowed=True),
        kappa_is_auto=_field(where, record, "kappa_is_auto", bool),
        precision=_field(where, record, "precision", str),
        status=_field(where, record, "status", str),
        finding=_field(where, record, "finding", str, none_allowed=True),
        golden=_accuracy(where, record, "golden"),
        truth=_accuracy(where, record, "truth"),
        operations=_field(where, record, "operations", int),
        stable_step=_field(where, record, "stable_step", NUMBER),
        steps=_field(where, record, "steps", int),
        residual=_field(where, record, "residual", NUMBER),
        hourglass_energy_ratio=_field(where, record, "hourglass_energy_ratio", NUMBER),
        ns_per_element_step=_field(where, record, "ns_per_element_step", NUMBER),
        wall_seconds=_field(where, record, "wall_seconds", NUMBER),
    )


def _tips(path, index, record):
    """The tips of a record, one for each published value; none for points of a kappa curve."""
    where = f"{path}: published[{index}]"
    kappa = _field(where, record, "kappa", NUMBER, none_allowed=True)
    if kappa is not None and not _field(where, record, "kappa_is_auto", bool):
        return []
    return [
        Tip(
            family=_field(where, record, "family", str),
            variant=" ".join(_field(where, record, "variants", list)),
            method=_field(where, record, "method", str),
            ok=_field(where, record, "status", str) == "ok",
            finding=_field(where, record, "finding", str, none_allowed=True) or "",
            source=_field(where, value, "source", str),
            to_published=_field(where, value, "ratio", NUMBER, none_allowed=True),
            to_truth=_field(where, value, "ratio_to_truth", NUMBER, none_allowed=True),
        )
        for value in _field(where, record, "values", list)
    ]


def _limit(path, index, record):
    where = f"{path}: limits[{index}]"
    reference = _field(where, record, "reference", str)
    if reference not in (*REFERENCES, "published"):
        raise ReportError(f"{where}.reference = {reference!r}: must be golden, truth or published")
    return Limit(
        case=_field(where, record, "case", str),
        method=_field(where, record, "method", str),
        kappa=_field(where, record, "kappa", str),
        reference=reference,
        figure=_field(where, record, "figure", str),
        below=_field(where, record, "below", NUMBER, none_allowed=True),
        above=_field(where, record, "above", NUMBER, none_allowed=True),
        found=_field(where, record, "found", NUMBER, none_allowed=True),
        at_kappa=_field(where, record, "at_kappa", NUMBER, none_allowed=True),
        holds=_field(where, record, "holds", bool),
        reason=_field(where, record, "reason", str),
    )
