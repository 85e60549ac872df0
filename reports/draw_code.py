"""Draws the code as it is: who includes whom, and the way of a displacement through it.

Usage: /usr/bin/python3 reports/draw_code.py [-o FOLDER]
Reads the sources only. Writes layers.svg and displacement.svg.
Exit codes: 0 done, 2 a picture would not be true: what it shows is not in the sources.
"""

import argparse
import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))
    sys.path.insert(2, str(Path(__file__).resolve().parent.parent / "ci"))

from common.command import exit_code
from common.files import writing, write_whole
from sandglass_report.displacement_picture import displacement_picture
from sandglass_report.layers_picture import layers_picture

PICTURES = {"layers.svg": layers_picture, "displacement.svg": displacement_picture}


def draw_pictures(folder):
    """Draws all, then writes them. Raises InputError when one would not be true."""
    texts = {name: draw() for name, draw in PICTURES.items()}
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        write_whole(folder / name, text)
        print(folder / name)


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default="reports/figures", help="folder")
    return exit_code(draw_pictures, parser.parse_args(arguments).output)


if __name__ == "__main__":
    sys.exit(main())
