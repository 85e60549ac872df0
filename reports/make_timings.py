"""Draws what takes how long from the files of `bench/growth.py` and `bench/refinement.py`.

Usage: /usr/bin/python3 reports/make_timings.py FILE... [-o FOLDER]
A file is named as the program that wrote it, growth.json or refinement.json.
Exit codes: 0 done, 2 an input is missing or broken.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.errors import InputError
from sandglass_report.drawing import draw
from sandglass_report.growth import growth_plate, read_growth
from sandglass_report.refinement import read_refinement, refinement_plate

PLATES = {
    "growth": lambda file: growth_plate(read_growth(file)),
    "refinement": lambda file: refinement_plate(read_refinement(file)),
}


def plate_of(file):
    """The plate of a file. Raises InputError."""
    if file.stem not in PLATES:
        raise InputError(f"{file}: must be named {' or '.join(f'{name}.json' for name in PLATES)}")
    return PLATES[file.stem](file)


def main(arguments=None):
    """The command line. Returns the exit code."""
    files_help = "growth.json of bench/growth.py, refinement.json of bench/refinement.py"
    return draw(__doc__, files_help, lambda files: [plate_of(file) for file in files], arguments)


if __name__ == "__main__":
    sys.exit(main())
