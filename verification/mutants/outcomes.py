"""Results of the mutants: a JSON file for each under build/, and the table RESULTS.md."""

import datetime
import json
import re

from common.files import write_json, write_whole
from common.program import ROOT
from patches import FOLDER

STORE = ROOT / "build" / "mutant-results"
TABLE = FOLDER / "RESULTS.md"
COLUMNS = ("mutant", "mistake", "verdict", "by", "s", "revision")
HEAD = """# Mutants

Made by `verification/mutants/run.py` on {day}, revision {revision}: {counts}.

Each row names the first test that failed. `README.md` describes how the mutants were chosen.

"""


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


def rows_of(text):
    """The rows of a table, name of the mutant -> its six cells."""
    rows = {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if re.match(r"\| \d{3}-", line) and len(cells) == len(COLUMNS):
            rows[cells[0]] = cells
    return rows


def _row(patch, before):
    """A mutant's cells, from its stored result or otherwise from the previous table."""
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
    text = HEAD.format(day=datetime.date.today(), revision=revision, counts=counts)
    text += "| " + " | ".join(COLUMNS) + " |\n" + "|---" * len(COLUMNS) + "|\n"
    text += "".join("| " + " | ".join(row) + " |\n" for row in rows)
    write_whole(TABLE, text)
    return rows
