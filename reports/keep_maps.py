"""Keeps failure maps of `sandglass stability --json` small, for the page of trees that made none.

Leaves out what the page does not show, and digits that nobody reads: a tenth remains.

Usage: /usr/bin/python3 reports/keep_maps.py FILE... [-o FOLDER]
Exit codes: 0 done, 2 an input is missing or broken.
"""

import argparse
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from sandglass_report.errors import ReportError  # noqa: E402 (the path must be set first)
from sandglass_report.maps import kept, read_maps  # noqa: E402
from sandglass_report.page import write_whole  # noqa: E402


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path, help="of sandglass stability --json")
    parser.add_argument("-o", "--output", type=Path, default="reports/maps", help="folder")
    options = parser.parse_args(arguments)
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        for file in options.files:
            document = kept(read_maps(file))
            place = options.output / f"{document['case']}.json"
            write_whole(place, json.dumps(document, separators=(",", ":")) + "\n")
            print(place)
    except (ReportError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
