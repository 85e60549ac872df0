"""Reading verdicts.json: what ran, how near it came, and which limits hold."""

from dataclasses import dataclass

from sandglass_report.accuracy import Accuracy
from sandglass_report.checks import NUMBER, entries, entry, facts, read_document
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
    document = read_document(path, f"sandglass verify --json {path} --results FOLDER")
    runs = tuple(_run(where, r) for where, r in entries(path, document, "records"))
    if not runs:
        raise ReportError(f"{path}: records is empty: nothing ran, there is nothing to report")
    limits = tuple(_limit(where, r) for where, r in entries(path, document, "limits"))
    published = entries(path, document, "published") if "published" in document else []
    tips = tuple(tip for where, record in published for tip in _tips(where, record))
    return Verdicts(facts(document), runs, limits, tips)


def _accuracy(where, record, key):
    """The accuracy figures against one reference, or None."""
    figures = entry(where, record, key, dict, none_allowed=True)
    if figures is None:
        return None
    return Accuracy(
        max=entry(f"{where}.{key}", figures, "max_relative_error", NUMBER),
        rms=entry(f"{where}.{key}", figures, "rms_relative_error", NUMBER),
        profile=entry(f"{where}.{key}", figures, "profile_relative_error", NUMBER, True),
    )


def _run(where, record):
    return Run(
        case=entry(where, record, "case", str),
        method=entry(where, record, "method", str),
        kappa=entry(where, record, "kappa", NUMBER, none_allowed=True),
        kappa_is_auto=entry(where, record, "kappa_is_auto", bool),
        precision=entry(where, record, "precision", str),
        status=entry(where, record, "status", str),
        finding=entry(where, record, "finding", str, none_allowed=True),
        golden=_accuracy(where, record, "golden"),
        truth=_accuracy(where, record, "truth"),
        operations=entry(where, record, "operations", int),
        stable_step=entry(where, record, "stable_step", NUMBER),
        steps=entry(where, record, "steps", int),
        residual=entry(where, record, "residual", NUMBER),
        hourglass_energy_ratio=entry(where, record, "hourglass_energy_ratio", NUMBER),
        ns_per_element_step=entry(where, record, "ns_per_element_step", NUMBER),
        wall_seconds=entry(where, record, "wall_seconds", NUMBER),
    )


def _tips(where, record):
    """The tips of a record, one for each published value; none for points of a kappa curve."""
    kappa = entry(where, record, "kappa", NUMBER, none_allowed=True)
    if kappa is not None and not entry(where, record, "kappa_is_auto", bool):
        return []
    return [
        Tip(
            family=entry(where, record, "family", str),
            variant=" ".join(entry(where, record, "variants", list)),
            method=entry(where, record, "method", str),
            ok=entry(where, record, "status", str) == "ok",
            finding=entry(where, record, "finding", str, none_allowed=True) or "",
            source=entry(where, value, "source", str),
            to_published=entry(where, value, "ratio", NUMBER, none_allowed=True),
            to_truth=entry(where, value, "ratio_to_truth", NUMBER, none_allowed=True),
        )
        for value in entry(where, record, "values", list)
    ]


def _limit(where, record):
    reference = entry(where, record, "reference", str)
    if reference not in (*REFERENCES, "published"):
        raise ReportError(f"{where}.reference = {reference!r}: must be golden, truth or published")
    return Limit(
        case=entry(where, record, "case", str),
        method=entry(where, record, "method", str),
        kappa=entry(where, record, "kappa", str),
        reference=reference,
        figure=entry(where, record, "figure", str),
        below=entry(where, record, "below", NUMBER, none_allowed=True),
        above=entry(where, record, "above", NUMBER, none_allowed=True),
        found=entry(where, record, "found", NUMBER, none_allowed=True),
        at_kappa=entry(where, record, "at_kappa", NUMBER, none_allowed=True),
        holds=entry(where, record, "holds", bool),
        reason=entry(where, record, "reason", str),
    )
