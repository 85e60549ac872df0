"""The entries of results/: those of other programs, and those that other people submitted."""

import math
import re
from dataclasses import dataclass, field

from results.entry import entry_files, read_entry
from sandglass_report import style
from sandglass_report.measured import OWN_MESH
from sandglass_report.points import Point

OURS = "Sandglass"
# An error within this factor of another is as good.
AS_GOOD = 1.05


@dataclass(frozen=True)
class Nearest:
    """The entry of Sandglass to compare with, from the same machine.

    as_good: whether its error is at most the other's. step, simulated, rest: ratios of the other's
    times for a step, a simulated second and equilibrium to its own; None if unknown.
    """

    element: str
    precision: str
    as_good: bool
    version: str  # of Sandglass
    step: float | None
    simulated: float | None
    rest: float | None

    def in_words(self):
        """A sentence for the chart."""
        parts = [
            f"{style.plain(value, 2)} times per {words}"
            for value, words in (
                (self.step, "step"),
                (self.simulated, "simulated second"),
                (self.rest, "equilibrium"),
            )
            if value
        ]
        than = f"{self.element} ({self.precision})"
        quality = "" if self.as_good else ", which is less accurate"
        return f"{', '.join(parts) or 'no times'} of {than}{quality}"


@dataclass(frozen=True)
class Submission:
    """An entry, its path, and the nearest entry of ours; None for ours."""

    name: str
    entry: dict
    nearest: Nearest | None = field(default=None)

    @property
    def ours(self):
        """Whether the program is Sandglass."""
        return self.entry["program"] == OURS

    @property
    def label(self):
        """Program and element."""
        return f"{self.entry['program']} {self.entry['element']}"

    @property
    def build(self):
        """The first words of its build flags."""
        return re.split("[,;]", self.entry["build"])[0]

    def error(self, reference="golden", figure="max"):
        """One error as a fraction, or None."""
        return self.entry["errors"].get(reference, {}).get(figure)

    def figure(self, key):
        """A figure that an entry may lack, or None."""
        return self.entry.get(key)

    def finding(self):
        """Its finding in the chart."""
        if self.ours:
            return "timed beside other programs"
        return self.nearest.in_words() if self.nearest else "nothing of ours to compare with"

    def elsewhere(self, own):
        """Machine and revision of its times if they differ from the page's, else nothing.

        own: machine and revision of the page, as in the verdicts. Another program has been timed
        beside the entry of Sandglass that is nearest to it, whose revision counts.
        """
        version = self.entry["version"] if self.ours else self.nearest and self.nearest.version
        same_machine = self.entry["machine"].startswith(own.get("processor", "unknown"))
        if same_machine and version == f"{own.get('version')} ({own.get('revision')})":
            return ""
        beside = f", Sandglass {version}" if version else ""
        return f"{self.entry['machine']}{beside}"

    def as_point(self, elements, own):
        """The Point of the main chart. elements: number of those of the case. own: of elsewhere."""
        entry, errors = self.entry, self.entry["errors"]
        ns, step = self.figure("ns_per_element_step"), self.figure("time_step")
        cost = 1e-9 * ns * elements if ns else None
        costs = {"ns": ns, "step": cost, "mean_step": step, "ok": True}
        costs["simulated"] = cost / step if cost and step else None
        return Point(
            *(entry["case"], self.label, None, True, None, entry["precision"], OWN_MESH, elements),
            finding=self.finding(),
            golden=errors.get("golden", {}),
            truth=errors.get("truth", {}),
            equilibrium=self.figure("seconds_to_rest"),
            measured_by=f"results/{self.name}: {entry['build']}; {entry['machine']}",
            elsewhere=self.elsewhere(own),
            group=entry["program"],
            **costs,
        )


def read_submissions(folder):
    """The Submissions of a folder, those of one case together, ours last. Raises InputError."""
    found = [(path.name, read_entry(path)) for path in entry_files(folder)]
    ours = [entry for _, entry in found if entry["program"] == OURS]
    submissions = [
        Submission(name, entry, None if entry["program"] == OURS else _nearest(entry, ours))
        for name, entry in found
    ]
    return sorted(submissions, key=lambda s: (s.entry["case"], s.ours, s.label, s.entry["build"]))


def _nearest(entry, ours):
    """The Nearest of an entry: our cheapest entry that is as good, else our most accurate one."""

    def error(one):
        return max(one["errors"].get("golden", {}).get("max", math.inf), style.FLOOR)

    def cost(one):
        return one.get("ns_per_element_step") or math.inf

    same = [one for one in ours if all(one[key] == entry[key] for key in ("case", "machine"))]
    if not same:
        return None
    good = [one for one in same if error(one) <= AS_GOOD * error(entry)]
    one = min(good, key=cost) if good else min(same, key=error)

    def ratio(key, scale=lambda e: 1.0):
        if not (entry.get(key) and one.get(key)):
            return None
        return entry[key] / scale(entry) / (one[key] / scale(one))

    steps = entry.get("time_step") and one.get("time_step")
    return Nearest(
        one["element"],
        one["precision"],
        bool(good),
        one["version"],
        ratio("ns_per_element_step"),
        ratio("ns_per_element_step", lambda e: e["time_step"]) if steps else None,
        ratio("seconds_to_rest"),
    )
