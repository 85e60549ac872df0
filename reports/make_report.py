"""Makes the page of the report from verdicts, results and references.

Usage: /usr/bin/python3 reports/make_report.py [--verdicts FILE] [--results FOLDER] [--cases FOLDER]
       [--reference FOLDER] [-o FILE]
Exit codes: 0 done, 2 an input is missing, broken or does not belong to the others.
"""

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from sandglass_report.errors import ReportError  # noqa: E402 (the path must be set first)
from sandglass_report.load import read_verdicts  # noqa: E402
from sandglass_report.page import write_report  # noqa: E402
from sandglass_report.subject import read_subjects  # noqa: E402


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--verdicts", type=Path, default="build/verdicts.json", help="of sandglass verify --json")
    add("--results", type=Path, default="build/verify", help="of sandglass verify --results")
    add("--cases", type=Path, default="cases", help="folder of case files")
    add("--reference", type=Path, default="reference", help="folder with golden/ and truth/")
    add("-o", "--output", type=Path, default="build/report/index.html", help="the page to write")
    options = parser.parse_args(arguments)
    start = time.monotonic()
    try:
        verdicts = read_verdicts(options.verdicts)
        subjects = read_subjects(verdicts, options.cases, options.reference, options.results)
        size = write_report(verdicts, subjects, options.output)
    except ReportError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    seconds = time.monotonic() - start
    print(f"{options.output}: {size / 1e6:.1f} MB, made in {seconds:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
