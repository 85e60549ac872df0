"""Makes the README's figure, and the text around it, from the records of `ci/verify`.

Usage: /usr/bin/python3 reports/make_headline.py [RECORDS]
RECORDS: build/report/figures/speed-accuracy.json, which `reports/make_report.py` writes. They are
stored in reports/figures/ beside the figure; the text of README.md follows.
Exit codes: 0 done, 2 an input is missing or broken.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import command_line, option
from common.files import read_json, write_json, write_whole
from common.program import ROOT
from sandglass_report import headline

RECORDS = "build/report/figures/speed-accuracy.json"
FOLDER = "reports/figures/"
FIGURE = f"{FOLDER}{headline.NAME}.svg"
README = "README.md"
GLOSSARY = "docs/glossary.md"


def make(records, root=ROOT):
    """Stores the records in a tree, and makes its figure and text. Raises InputError."""
    document = read_json(records, "ci/verify")
    headline.require_valid(records, document)
    text = (root / README).read_text(encoding="utf-8")
    readme = headline.replaced(text, headline.caption(document, FIGURE, GLOSSARY))
    write_json(root / FOLDER / f"{headline.NAME}.json", document)
    for path, text in ((root / README, readme), (root / FIGURE, headline.figure(document))):
        write_whole(path, text)
        print(path)


main = command_line(
    lambda options: make(options.records),
    __doc__,
    option("records", type=Path, nargs="?", default=RECORDS, help="of ci/verify"),
)


if __name__ == "__main__":
    sys.exit(main())
