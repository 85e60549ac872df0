"""Reduces failure maps of `sandglass stability --json` for storage with the sources.

Removes data that the page does not show, and superfluous digits; a tenth of the size remains.

Usage: /usr/bin/python3 reports/keep_maps.py FILE... [-o FOLDER]
Exit codes: 0 done, 2 an input is missing or broken.
"""

import json
import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import command_line, option
from common.files import write_whole, writing
from sandglass_report.maps import kept, read_maps


def keep(options):
    """Writes the small maps and prints where. Raises InputError."""
    with writing(options.output):
        options.output.mkdir(parents=True, exist_ok=True)
    for file in options.files:
        document = kept(read_maps(file))
        place = options.output / f"{document['case']}.json"
        write_whole(place, json.dumps(document, separators=(",", ":")) + "\n")
        print(place)


main = command_line(
    keep,
    __doc__,
    option("files", nargs="+", type=Path, help="of sandglass stability --json"),
    option("-o", "--output", type=Path, default="reports/maps", help="folder"),
)


if __name__ == "__main__":
    sys.exit(main())
