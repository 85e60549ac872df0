"""Reads verdicts.json: the runs, their errors, and the limits."""

from dataclasses import dataclass

from common.errors import InputError
from common.files import read_json
from common.records import NUMBER, as_dataclass, entries, entry, facts, key
from sandglass_report.accuracy import Accuracy

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
    finding: str | None  # how it failed, or "good"; None without a golden to compare with
    golden: Accuracy | None
    truth: Accuracy | None
    operations: int  # per element and step, without loads
    load_in_steps: str | None  # table of the first load that steps compute, such as "contact"
    stable_step: float  # s, undeformed
    residual: float
    hourglass_energy_ratio: float  # of the strain energy
    step_remark: str  # about steps of single states; usually empty
    ns: float | None = key("ns_per_element_step")  # None: not measured, or there is no step
    ns_low: float | None = key("ns_lower_quartile")
    ns_high: float | None = key("ns_upper_quartile")
    check_ns: float | None = key("check_ns_per_element_step")  # of checks, shared out over steps
    mean_step: float | None = key("mean_step_seconds")  # s, of the case's own motion
    simulated: float | None = key("seconds_per_simulated_second")
    equilibrium: float | None = key("equilibrium_seconds")  # None for a case in motion
    evaluations: int | None = key("evaluations")
    motion: float | None = key("motion_seconds")  # None for a quasi-static case
    steps: int | None = key("steps")

    @property
    def ok(self):
        """Whether the run finished."""
        return self.status == "ok"

    @property
    def is_main(self):
        """Whether the method ran with its default settings, not as a point of its kappa curve."""
        return self.kappa is None or self.kappa_is_auto

    @property
    def label(self):
        """The method's name, with its kappa if it has one."""
        if self.kappa is None:
            return self.method
        return f"{self.method} κ {'auto' if self.kappa_is_auto else f'{self.kappa:g}'}"

    @property
    def file_name(self):
        """Name of the result file that `sandglass verify --results` writes for this run."""
        kappa = "" if self.is_main else f".{self.kappa!r}"
        return f"{self.case}.{self.method}{kappa}.h5"


@dataclass(frozen=True)
class Program:
    """Another program's values: one for each number of elements per side, or a single one."""

    program: str
    elements: list
    values: list
    source: str


@dataclass(frozen=True)
class Tip:
    """One method on one variant of a case with a published value; ratios are None without one."""

    family: str
    variant: str  # the names on all axes, the last one is that of the mesh
    method: str
    ok: bool
    finding: str
    source: str
    set: str
    component: str
    published: float
    computed: float | None
    programs: tuple
    scatter: float | None  # of a measured value; None for other published values
    of: str  # "end" or, of a motion, "peak" or "period"; "force" of obstacles
    golden: float | None
    seconds: float | None  # to equilibrium or, of a case in motion, of the motion
    to_published: float | None = key("ratio")
    to_truth: float | None = key("ratio_to_truth")


@dataclass(frozen=True)
class Limit:
    """One expectation of a case and its outcome; figures are fractions."""

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
        """Names of the methods, in the order of the file, which is that of the solver."""
        return tuple(dict.fromkeys(run.method for run in self.runs))


def read_verdicts(path):
    """Verdicts of a verdicts.json. Raises InputError if it is missing or invalid."""
    document = read_json(path, f"sandglass verify --json {path} --results FOLDER")
    runs = tuple(as_dataclass(Run, *found) for found in entries(path, document, "records"))
    if not runs:
        raise InputError(f"{path}: records = [] must not be empty: nothing ran")
    limits = tuple(_limit(*found) for found in entries(path, document, "limits"))
    published = entries(path, document, "published") if "published" in document else []
    tips = tuple(tip for found in published for tip in _tips(*found))
    return Verdicts(facts(document), runs, limits, tips)


def _tips(where, record):
    """The tips of a record, one for each published value; none for points of a kappa curve."""
    kappa = entry(where, record, "kappa", NUMBER, none_allowed=True)
    if kappa is not None and not entry(where, record, "kappa_is_auto", bool):
        return []
    known = {
        "variant": " ".join(entry(where, record, "variants", list)),
        "ok": entry(where, record, "status", str) == "ok",
        "finding": entry(where, record, "finding", str, none_allowed=True) or "",
    }
    known["seconds"] = _seconds(where, record)
    tips = []
    for place, value in entries(where, record, "values"):
        programs = tuple(as_dataclass(Program, *p) for p in entries(place, value, "programs"))
        tips.append(as_dataclass(Tip, place, record | value, programs=programs, **known))
    return tips


def _seconds(where, record):
    """The time of a run: of its search for equilibrium, or of its motion."""
    known = (
        entry(where, record, name, NUMBER, none_allowed=True)
        for name in ("equilibrium_seconds", "motion_seconds")
    )
    return next((seconds for seconds in known if seconds is not None), None)


def _limit(where, record):
    """A limit of the verdicts. Raises InputError."""
    limit = as_dataclass(Limit, where, record)
    if limit.reference not in (*REFERENCES, "published", "measured"):
        allowed = "golden, truth, published or measured"
        raise InputError(f"{where}.reference = {limit.reference!r} must be {allowed}")
    return limit
