"""The shared command line of the scripts that draw static figures from files."""

import argparse
from pathlib import Path

from common.command import exit_code
from common.files import writing
from sandglass_report.plates import save_plate


def draw(description, files_help, plates_of, arguments=None):
    """Saves the plates of plates_of(files) and prints their paths. Returns the exit code.

    description: of the command; its first line is shown. files_help: description of the files.
    plates_of: from a list of Paths to a list of Plates. arguments: of the command line.
    """

    def save(options):
        plates = plates_of(options.files)
        with writing(options.output):
            options.output.mkdir(parents=True, exist_ok=True)
            for plate in plates:
                print(*save_plate(plate, options.output), sep="\n")

    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path, help=files_help)
    parser.add_argument(
        "-o", "--output", type=Path, default="reports/figures", help="folder of the figures"
    )
    return exit_code(save, parser.parse_args(arguments))
