"""The table of bench/README.md from the files that `ci/peers --json` wrote.

Usage: /usr/bin/python3 bench/peer_table.py FILE...; those of bench/measured by default.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import exit_code
from common.files import read_json
from common.program import ROOT
from rest_records import table

# Builds for this processor; those that ship are a little slower, and in the files.
SHOWN = ("native", "")


def percent(fraction):
    """In percent, without the sign."""
    return f"{100 * fraction:.3g}" if fraction >= 1e-6 else f"{100 * fraction:.0e}"


COLUMNS = (
    ("program, element", "label", str),
    ("numbers", "precision", str),
    ("to golden, %", "golden", percent),
    ("to truth, %", "truth", percent),
    ("ns", "ns_per_element_step", lambda ns: f"{float(f'{ns:.3g}'):g}"),
    ("step, ms", "time_step", lambda seconds: f"{1e3 * seconds:.3g}"),
    ("to rest, s", "seconds", "{:.3g}".format),
)


def rows_of(documents):
    """A row for each element at rest, with the cost of its steps, from files of one case."""
    rows = {}
    for document in documents:
        for record in document["at_rest"]:
            if (record["build"] or "") in SHOWN:
                label = f"{record['program']} {record['element']}"
                rows.setdefault((label, record["precision"]), {**record, "label": label})
        for record in document["in_motion"]:
            label = f"{record['program']} {record['element']}"
            row = rows.get((label, record["precision"]))
            if row and (record["build"] or "") in SHOWN and not row["ns_per_element_step"]:
                row["ns_per_element_step"] = record["ns_per_element_step"]
    return sorted(rows.values(), key=lambda row: row["label"].startswith("Sandglass"))


def tables(paths):
    """The Markdown tables of all cases, one after another. Raises InputError."""
    documents = [read_json(path, "ci/peers --json") for path in paths]
    parts = []
    for case in dict.fromkeys(document["case"] for document in documents):
        own = [document for document in documents if document["case"] == case]
        elements, processor = own[0]["elements"], own[0]["processor"]
        parts += [f"`{case}`, {elements} elements, one thread of an {processor}:", ""]
        parts += [table(rows_of(own), COLUMNS), ""]
    return "\n".join(parts).rstrip()


def main(arguments):
    """Prints the tables."""
    print(tables(arguments or sorted((ROOT / "bench/measured").glob("*.json"))))


if __name__ == "__main__":
    sys.exit(exit_code(main, sys.argv[1:]))
