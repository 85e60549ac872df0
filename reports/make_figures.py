"""Draws static figures from the files of other commands, according to their contents.

Failure maps of `sandglass stability --json`; error against cost of `sandglass choose --all --json`,
whose files are merged into one figure, as other tolerances try the adaptive method at other
accuracies; growth.json of `bench/growth.py`; refinement.json of `bench/refinement.py`.

Usage: /usr/bin/python3 reports/make_figures.py FILE... [-o FOLDER]
Exit codes: 0 done, 2 an input is missing or broken.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import command_line, option
from common.errors import InputError
from common.files import read_json, writing
from sandglass_report.curves import curve_plate, read_costs
from sandglass_report.growth import growth_plate, read_growth
from sandglass_report.maps import map_plates, read_maps
from sandglass_report.plates import save_plate
from sandglass_report.refinement import read_refinement, refinement_plate

# A key of a file, or the name of a file with records -> function that makes plates from a list of
# such files.
PLATES = {
    "maps": lambda files: [plate for file in files for plate in map_plates(read_maps(file))],
    "rungs": lambda files: [curve_plate(read_costs(files))],
    "growth": lambda files: [growth_plate(read_growth(file)) for file in files],
    "refinement": lambda files: [refinement_plate(read_refinement(file)) for file in files],
}


def kind_of(file):
    """The key of PLATES for a file. Raises InputError."""
    for kind in PLATES:
        if kind in read_json(file) or kind == file.stem:
            return kind
    raise InputError(f"{file}: must have maps or rungs, or be growth.json or refinement.json")


def make(options):
    """Saves the plates and prints their paths. Raises InputError."""
    kinds = {}
    for file in options.files:
        kinds.setdefault(kind_of(file), []).append(file)
    plates = [plate for kind, files in kinds.items() for plate in PLATES[kind](files)]
    with writing(options.output):
        options.output.mkdir(parents=True, exist_ok=True)
        for plate in plates:
            print(*save_plate(plate, options.output), sep="\n")


main = command_line(
    make,
    __doc__,
    option("files", nargs="+", type=Path, help="of stability, choose --all, growth or refinement"),
    option("-o", "--output", type=Path, default="reports/figures", help="folder of the figures"),
)


if __name__ == "__main__":
    sys.exit(main())
