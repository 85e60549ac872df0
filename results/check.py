"""Checks the entries of results/: schema, hash of the displacements, and errors by scoring again.

Usage: /usr/bin/python3 results/check.py [ENTRY.json...]; all of results/ by default.
Exit codes: 0 all are correct, 1 one is not, 2 bad usage.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import command_line, option
from common.errors import InputError
from results.entry import check, entry_files


def check_all(options):
    """Checks the entries; returns the exit code."""
    wrong = 0
    for path in options.entries or entry_files():
        try:
            check(path)
            print(f"{path.name}: right")
        except InputError as error:
            print(f"error: {error}", file=sys.stderr)
            wrong += 1
    return 1 if wrong else 0


main = command_line(
    check_all,
    __doc__,
    option("entries", nargs="*", type=Path, metavar="ENTRY.json"),
)


if __name__ == "__main__":
    sys.exit(main())
