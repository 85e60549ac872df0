"""Results of the mutants: a JSON file for each under build/, and the table RESULTS.md."""

import collections
import datetime
import json
import re

from common.files import write_json, write_whole
from common.program import ROOT
from patches import FOLDER

STORE = ROOT / "build" / "mutant-results"
TABLE = FOLDER / "RESULTS.md"
COLUMNS = ("mutant", "mistake", "verdict", "by", "s", "revision")
CLEAN = "clean"


def store(name, result):
    """Stores a result, a dict, under a mutant's name."""
    STORE.mkdir(parents=True, exist_ok=True)
    write_json(STORE / f"{name}.json", result)


def stored(name):
    """The result stored under a name, or None."""
    try:
        return json.loads((STORE / f"{name}.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def killers():
    """The number of mutants that each program has killed, among the stored results."""
    found = collections.Counter()
    for path in STORE.glob("[0-9]*.json"):
        found[(stored(path.stem) or {}).get("program")] += 1
    return found


def rows_of(text):
    """The rows of a table, name of the mutant -> its six cells."""
    rows = {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if re.match(r"\| \d{3}-", line) and len(cells) == len(COLUMNS):
            rows[cells[0]] = cells
    return rows


def _row(patch, before):
    """A mutant's cells, from its stored result or else from the previous table."""
    result = stored(patch.name)
    if result is None or result["patch"] != patch.digest:
        verdict = before.get(patch.name, ["", "", "not run", "-", "-", "-"])[2:]
        return [patch.name, patch.mistake, *verdict]
    by, seconds = result["by"].replace("|", "/") or "-", f"{result['seconds']:.0f}"
    return [patch.name, patch.mistake, result["verdict"], by, seconds, result["revision"]]


def write_table(patches, revision):
    """Rewrites RESULTS.md from the stored results; returns its rows."""
    before = rows_of(TABLE.read_text(encoding="utf-8")) if TABLE.exists() else {}
    rows = [_row(patch, before) for patch in patches]
    verdicts = [row[2] for row in rows]
    counts = ", ".join(f"{verdicts.count(v)} {v}" for v in sorted(set(verdicts)))
    clean = stored(CLEAN)
    text = "# Mutants\n\n"
    today = datetime.date.today()
    text += f"Made by `verification/mutants/run.py` on {today}, revision {revision}: {counts}.\n"
    if clean:
        runs, alarms = len(clean["alarms"]), sum(map(len, clean["alarms"]))
        text += f"The tree without a mistake: runs {runs}, false alarms {alarms}.\n"
    text += "\nEach row names the first test that failed; programs run in order of their cost.\n\n"
    text += "| " + " | ".join(COLUMNS) + " |\n" + "|---" * len(COLUMNS) + "|\n"
    text += "".join("| " + " | ".join(row) + " |\n" for row in rows)
    write_whole(TABLE, text)
    return rows
