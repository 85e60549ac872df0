"""Draws seconds and steps to rest over mesh size from a file of `bench/growth.py --json`.

Usage: /usr/bin/python3 reports/make_growth.py FILE [-o FOLDER]
Exit codes: 0 done, 2 an input is missing or broken.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from sandglass_report.drawing import draw
from sandglass_report.growth import growth_plate, read_growth


def main(arguments=None):
    """The command line. Returns the exit code."""

    def plates_of(files):
        return [growth_plate([record for file in files for record in read_growth(file)])]

    return draw(__doc__, "of bench/growth.py --json", plates_of, arguments)


if __name__ == "__main__":
    sys.exit(main())
