"""The baseline: the accepted figures, with date and reason.

One JSON file, one record a line, so that its diffs can be read.
"""

import json
from dataclasses import dataclass, field

from common.errors import InputError, suggestion
from common.files import read_json, write_whole
from common.records import entries, entry

from .compare import NOISY, SAME, compare
from .interval import Interval
from .records import AREAS, MAY_DIFFER, OF_MACHINE, Record

FORMAT = 1
DIGITS = 6  # of errors and ratios: a thousandth of what the rules tell apart


@dataclass
class Baseline:
    """Accepted records and the history of their acceptance.

    records: of all machines, as found on `machine`, the first. machines: by name of a machine, its
    own records: those of OF_MACHINE, and where they are not the first machine's, of MAY_DIFFER.
    """

    history: list = field(default_factory=list)
    records: list = field(default_factory=list)
    machines: dict = field(default_factory=dict)
    machine: str | None = None

    def knows(self, area, machine):
        """Whether the accepted figures of an area apply to a machine."""
        own = _figures(area, self.machines.get(machine, []))
        return bool(own) or self._is_common(area, machine)

    def of(self, area, machine):
        """All records of an area on a machine; an unknown machine has none of its own."""
        common = () if area in OF_MACHINE else self.records
        return _figures(area, [*common, *self.machines.get(machine, [])])

    def replace(self, area, machine, figures_by_name):
        """Replaces the records of an area."""
        if self._is_common(area, machine):
            self.records = _replaced(self.records, area, figures_by_name)
        elif area in OF_MACHINE:
            self._replace_own(area, machine, figures_by_name)
        else:  # the figures of the first machine are kept
            first = _figures(area, self.records)
            common = {name: first.get(name, here) for name, here in figures_by_name.items()}
            own = {n: here for n, here in figures_by_name.items() if _differ(common[n], here)}
            self.records = _replaced(self.records, area, common)
            self._replace_own(area, machine, own)

    def _is_common(self, area, machine):
        """Whether the figures of an area are the same on all machines."""
        if area in MAY_DIFFER:
            return machine in (None, self.machine)
        return area not in OF_MACHINE

    def _replace_own(self, area, machine, figures_by_name):
        own = self.machines.get(machine, [])
        self.machines[machine] = _replaced(own, area, figures_by_name)


def _figures(area, records):
    """Figures of an area by name; later records replace earlier ones."""
    return {record.name: record.figures for record in records if record.area == area}


def _replaced(records, area, figures_by_name):
    """The records with those of an area replaced."""
    kept = [record for record in records if record.area != area]
    kept += [Record(area, name, figures) for name, figures in figures_by_name.items()]
    return sorted(kept, key=lambda record: (AREAS.index(record.area), record.name))


def _record(where, found):
    """One line of the file as a Record."""
    area, name = entry(where, found, "area", str), entry(where, found, "name", str)
    if area not in AREAS:
        raise InputError(f"{where}.area = {area!r} is not known; {suggestion(area, AREAS)}")
    figures = {}
    for key, value in found.items():
        if key in ("area", "name"):
            continue
        if isinstance(value, list):
            if len(value) != 3 or not all(isinstance(part, (int, float)) for part in value):
                raise InputError(f"{where}.{key} = {value} must be low, median and high")
            value = Interval(*value)
        elif isinstance(value, bool) or not isinstance(value, (int, float, str)):
            raise InputError(f"{where}.{key} = {value!r} must be a number or a text")
        figures[key] = value
    return Record(area, name, figures)


def read(path):
    """The Baseline of a file. Raises InputError."""
    document = read_json(path)
    if document.get("format") != FORMAT:
        raise InputError(f"{path}: format = {document.get('format')!r} must be {FORMAT}")
    machines = entry(path, document, "machines", dict)
    machine = entry(path, document, "machine", str) if "machine" in document else None
    return Baseline(
        entry(path, document, "history", list),
        [_record(*found) for found in entries(path, document, "records")],
        {
            name: [_record(*found) for found in entries(f"{path}: machines", machines, name)]
            for name in machines
        },
        machine,
    )


def _line(entry):
    """One line of the file."""
    return json.dumps(entry, ensure_ascii=False, allow_nan=False)


def _entry(record):
    """A Record as it is written."""
    figures = {
        key: [value.low, value.median, value.high] if isinstance(value, Interval) else value
        for key, value in record.figures.items()
    }
    return {"area": record.area, "name": record.name} | figures


def _list(lines, indent):
    """A JSON list, an entry a line."""
    if not lines:
        return "[]"
    inner = ",\n".join(" " * (indent + 1) + line for line in lines)
    return f"[\n{inner}\n{' ' * indent}]"


def text_of(baseline):
    """The text of the file."""
    machines = [
        f"{_line(name)}: {_list([_line(_entry(record)) for record in records], 2)}"
        for name, records in sorted(baseline.machines.items())
    ]
    inner = (
        "{\n" + ",\n".join("  " + machine for machine in machines) + "\n }" if machines else "{}"
    )
    first = f' "machine": {_line(baseline.machine)},\n' if baseline.machine else ""
    return (
        f'{{\n "format": {FORMAT},\n{first}'
        f' "history": {_list([_line(entry) for entry in baseline.history], 1)},\n'
        f' "records": {_list([_line(_entry(record)) for record in baseline.records], 1)},\n'
        f' "machines": {inner}\n}}\n'
    )


def write(path, baseline):
    """Writes the file atomically. Raises InputError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, text_of(baseline))


def _rounded(value):
    """A figure as stored: errors and ratios are rounded, counts are not."""
    if isinstance(value, Interval):
        return Interval(*(_rounded(part) for part in (value.low, value.median, value.high)))
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def _accepted(area, outcomes, figures):
    """A record as stored in the baseline: figures that count as the same keep their old value.

    So errors cannot creep by less than their margin each time, and a diff shows what changed.
    """
    kept = {}
    for figure, value in figures.items():
        outcome = outcomes.get(figure)
        stays = outcome and outcome.verdict in (SAME, NOISY) and outcome.baseline is not None
        kept[figure] = outcome.baseline if stays else value if area == "memory" else _rounded(value)
    return kept


def accept(baseline, run, areas, reason, date):
    """Replaces the baseline's records of `areas` by those of a run, and records the reason.

    Returns the changes by area. Raises InputError where a ratio has no interval.
    """
    for record in run.records:
        for figure, value in record.figures.items():
            if isinstance(value, Interval) and value.low == 0.0:
                raise InputError(f"{record.name}: {figure}: too few processes to accept; use more")
    if set(areas) & set(MAY_DIFFER):
        baseline.machine = baseline.machine or run.machine
    outcomes = {}
    for outcome in compare(baseline, run, areas):
        outcomes.setdefault((outcome.area, outcome.name), {})[outcome.figure] = outcome
    changed = {}
    for area in areas:
        before = baseline.of(area, run.machine)
        found = {record.name: record.figures for record in run.records if record.area == area}
        after = {}
        for name, figures in found.items():
            after[name] = _accepted(area, outcomes.get((area, name), {}), figures)
            if name in before and not _differ(before[name], after[name]):
                after[name] = before[name]  # with its time, so that a diff shows what changed
        counts = {
            "new": len(after.keys() - before.keys()),
            "changed": sum(
                _differ(before[name], after[name]) for name in after.keys() & before.keys()
            ),
            "gone": len(before.keys() - after.keys()),
        }
        told = ", ".join(f"{count} {what}" for what, count in counts.items() if count)
        if told:
            changed[area] = told
        baseline.replace(area, run.machine, after)
    entry = {"date": date, "revision": run.revision, "reason": reason.strip(), "changed": changed}
    if run.machine and set(areas) & {*OF_MACHINE, *MAY_DIFFER}:
        entry["machine"] = run.machine
    baseline.history.append(entry)
    return changed


def _differ(before, after):
    """Whether two versions of a record differ in more than their times."""

    def gated(figures):
        return {key: value for key, value in figures.items() if not key.startswith("trend")}

    return gated(before) != gated(after)
