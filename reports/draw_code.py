"""Draws the code as it is: who includes whom, and the way of a displacement through it.

Usage: /usr/bin/python3 reports/draw_code.py [-o FOLDER]
Reads the sources only. Writes layers.svg and displacement.svg.
Exit codes: 0 done, 2 a picture would not be true: what it shows is not in the sources.
"""

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from sandglass_report.displacement_picture import displacement_picture  # noqa: E402 (path first)
from sandglass_report.errors import ReportError  # noqa: E402
from sandglass_report.layers_picture import layers_picture  # noqa: E402
from sandglass_report.page import write_whole  # noqa: E402

PICTURES = {"layers.svg": layers_picture, "displacement.svg": displacement_picture}


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default="reports/figures", help="folder")
    folder = parser.parse_args(arguments).output
    try:
        texts = {name: draw() for name, draw in PICTURES.items()}
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            write_whole(folder / name, text)
            print(folder / name)
    except (ReportError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
