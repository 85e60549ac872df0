"""The tables of bench/README.md, from the entries of results/ by the authors of Sandglass.

Usage: /usr/bin/python3 bench/peer_table.py
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import exit_code
from measuring import table
from results.entry import entry_files, read_entry

AUTHORS = "the authors of Sandglass"
# Of several builds, the one for this processor is shown; the others are in the entries.
OTHER_BUILDS = ("shipped", "plain")


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
    ("to equilibrium, s", "seconds_to_rest", "{:.3g}".format),
)


def row_of(entry):
    """The cells of an entry's row."""
    errors = {name: figures["max"] for name, figures in entry["errors"].items()}
    return (
        dict.fromkeys(key for _, key, _ in COLUMNS)
        | entry
        | errors
        | {"label": f"{entry['program']} {entry['element']}"}
    )


def tables(measured):
    """The Markdown tables of entries, one for each case."""
    measured = [entry for entry in measured if entry["submitted_by"] == AUTHORS]
    parts = []
    for case in sorted({entry["case"] for entry in measured}):
        own = [
            entry
            for entry in measured
            if entry["case"] == case and not entry["build"].startswith(OTHER_BUILDS)
        ]
        own.sort(key=lambda entry: entry["program"] == "Sandglass")
        parts += [f"`{case}`, on an {own[0]['machine']}:", "", table(map(row_of, own), COLUMNS), ""]
    return "\n".join(parts).rstrip()


def main(_):
    """Prints the tables."""
    print(tables(map(read_entry, entry_files())))


if __name__ == "__main__":
    sys.exit(exit_code(main, sys.argv[1:]))
