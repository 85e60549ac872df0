"""The baseline: the accepted figures, with date and reason.

One JSON file with one record per line, for readable diffs.
"""

import json
from dataclasses import dataclass, field

from common.errors import InputError, suggestion
from common.files import read_json, write_whole
from common.records import entries, entry

from .figures import AREAS, SAME, compare

FORMAT = 1
DIGITS = 6  # of errors: a thousandth of the differences that the rules distinguish


@dataclass
class Baseline:
    """Accepted figures and the history of their acceptance.

    figures: of all machines, as found on `machine`, the first. machines: name of another -> the
    errors that differ there: instruction sets round differently, and adaptivity raises packs.
    """

    history: list = field(default_factory=list)
    figures: dict = field(default_factory=dict)
    machines: dict = field(default_factory=dict)
    machine: str | None = None

    def of(self, areas, machine):
        """The figures of some areas on a machine."""
        whole = self.figures | self.machines.get(machine, {})
        return {key: figures for key, figures in whole.items() if key[0] in areas}


def _figures(where, document, key):
    """The figures of a list of records. Raises InputError."""
    figures = {}
    for place, found in entries(where, document, key):
        area, name = entry(place, found, "area", str), entry(place, found, "name", str)
        if area not in AREAS:
            raise InputError(f"{place}.area = {area!r} is not known; {suggestion(area, AREAS)}")
        values = {key: value for key, value in found.items() if key not in ("area", "name")}
        for key, value in values.items():
            if isinstance(value, bool) or not isinstance(value, (int, float, str)):
                raise InputError(f"{place}.{key} = {value!r} must be a number or a text")
        figures[area, name] = values
    return figures


def read(path):
    """The Baseline of a file. Raises InputError."""
    document = read_json(path)
    if document.get("format") != FORMAT:
        raise InputError(f"{path}: format = {document.get('format')!r} must be {FORMAT}")
    machines = entry(path, document, "machines", dict)
    return Baseline(
        entry(path, document, "history", list),
        _figures(path, document, "records"),
        {name: _figures(f"{path}: machines", machines, name) for name in machines},
        document.get("machine"),
    )


def text_of(baseline):
    """The text of the file."""

    def listed(values, indent):
        inner = ",\n".join(" " * (indent + 1) + json.dumps(v, ensure_ascii=False) for v in values)
        return f"[\n{inner}\n{' ' * indent}]" if values else "[]"

    def records(figures, indent):
        order = sorted(figures.items(), key=lambda one: (AREAS.index(one[0][0]), one[0][1]))
        return listed([{"area": k[0], "name": k[1]} | found for k, found in order], indent)

    machines = [
        f"  {json.dumps(name)}: {records(figures, 2)}"
        for name, figures in sorted(baseline.machines.items())
        if figures
    ]
    inner = "{\n" + ",\n".join(machines) + "\n }" if machines else "{}"
    return (
        f'{{\n "format": {FORMAT},\n "machine": {json.dumps(baseline.machine)},\n'
        f' "history": {listed(baseline.history, 1)},\n'
        f' "records": {records(baseline.figures, 1)},\n "machines": {inner}\n}}\n'
    )


def write(path, baseline):
    """Writes the file atomically. Raises InputError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, text_of(baseline))


def _accepted(outcomes, figures):
    """A record as stored: figures that count as equal keep their old value.

    So errors cannot creep up by less than their margin each time, and a diff shows real changes.
    """
    kept = {}
    for figure, value in figures.items():
        if outcomes[figure].verdict == SAME:
            kept[figure] = outcomes[figure].baseline
        else:
            kept[figure] = float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value
    return kept


def accept(baseline, found, areas, machine, about):
    """Replaces the baseline's figures in `areas` on a machine by those found.

    about: date, revision and reason, for the history. Returns the changes by area, in words.
    """
    baseline.machine = baseline.machine or machine
    before, outcomes = baseline.of(areas, machine), {}
    for outcome in compare(before, found):
        outcomes.setdefault((outcome.area, outcome.name), {})[outcome.figure] = outcome
    after = {key: _accepted(outcomes[key], figures) for key, figures in found.items()}
    changed = {}
    for area in areas:
        was, now = ({k: f[k] for k in f if k[0] == area} for f in (before, after))
        counts = {
            "new": len(now.keys() - was.keys()),
            "changed": sum(was[key] != now[key] for key in now.keys() & was.keys()),
            "gone": len(was.keys() - now.keys()),
        }
        if any(counts.values()):
            changed[area] = ", ".join(f"{count} {what}" for what, count in counts.items() if count)
    for figures in (baseline.figures, *baseline.machines.values()):
        for key in before.keys() - after.keys():
            figures.pop(key, None)
    own = baseline.machines.setdefault(machine, {})
    for key, figures in after.items():
        if key[0] == "operations" or machine in (None, baseline.machine):
            baseline.figures[key] = figures
        elif baseline.figures.setdefault(key, figures) != figures:
            own[key] = figures
        else:
            own.pop(key, None)
    baseline.machines = {name: figures for name, figures in baseline.machines.items() if figures}
    baseline.history.append(about | {"changed": changed, "machine": machine})
    return changed
