"""Draws error against cost per step from files of `sandglass choose --all --json`.

Files of the same case are merged: other tolerances try the adaptive method at other accuracies.

Usage: /usr/bin/python3 reports/make_curves.py FILE... [-o FOLDER]
Exit codes: 0 done, 2 an input is missing or broken.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from sandglass_report.curves import curve_plate, read_costs
from sandglass_report.drawing import draw


def main(arguments=None):
    """The command line. Returns the exit code."""

    def plates_of(files):
        return [curve_plate(read_costs(files))]

    return draw(__doc__, "of sandglass choose --all --json", plates_of, arguments)


if __name__ == "__main__":
    sys.exit(main())
