"""Draws the failure maps of `sandglass stability --json` as static figures.

Usage: /usr/bin/python3 reports/make_maps.py FILE... [-o FOLDER]
Exit codes: 0 done, 2 an input is missing or broken.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from sandglass_report.drawing import draw
from sandglass_report.maps import map_plates, read_maps


def main(arguments=None):
    """The command line. Returns the exit code."""

    def plates_of(files):
        return [plate for file in files for plate in map_plates(read_maps(file))]

    return draw(__doc__, "of sandglass stability --json", plates_of, arguments)


if __name__ == "__main__":
    sys.exit(main())
