"""The command line of the scripts that draw static figures from files."""

import argparse
import sys
from pathlib import Path

from sandglass_report.errors import ReportError
from sandglass_report.plates import save_plate


def draw(description, files_help, plates_of, arguments=None):
    """Saves the plates of plates_of(files) and prints their paths. Returns the exit code."""
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path, help=files_help)
    parser.add_argument(
        "-o", "--output", type=Path, default="reports/figures", help="folder of the figures"
    )
    options = parser.parse_args(arguments)
    try:
        plates = plates_of(options.files)
        options.output.mkdir(parents=True, exist_ok=True)
        for plate in plates:
            print(*save_plate(plate, options.output), sep="\n")
    except (ReportError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0
