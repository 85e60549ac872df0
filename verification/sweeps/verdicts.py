"""Joins files of `sandglass verify --json`, one per case, into one for all cases.

Usage: /usr/bin/python3 verification/sweeps/verdicts.py FILE... [-o FILE]
Prints the broken limits. Exit codes: 0 all limits hold, 1 one is broken (the joined file is still
written), 2 an input is missing, invalid, or from another program or machine.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent.parent))

from common.command import command_line, option
from common.errors import InputError
from common.files import read_json, write_json


def joined(documents):
    """One document from many: lists are joined, everything else must be equal. Raises InputError.

    documents: path -> dict, at least one.
    """
    first, *others = documents
    whole = {
        key: value[:] if isinstance(value, list) else value
        for key, value in documents[first].items()
    }
    for path in others:
        document = documents[path]
        if document.keys() != whole.keys():
            raise InputError(f"{path}: must have the keys of {first}: {', '.join(whole)}")
        for key, value in document.items():
            if isinstance(value, list):
                whole[key] += value
            elif value != whole[key]:
                raise InputError(f"{path}: {key} = {value!r} must be {whole[key]!r}, as in {first}")
    return whole


def work(options):
    """Joins, writes and prints; returns the exit code. Raises InputError."""
    whole = joined({path: read_json(path, "sandglass verify --json") for path in options.files})
    if options.output:
        write_json(options.output, whole)
    broken = [limit for limit in whole["limits"] if not limit["holds"]]
    for limit in broken:
        print("BROKEN {case} {method} kappa {kappa}: {figure}, {reference}".format(**limit))
    return 1 if broken else 0


main = command_line(
    work,
    __doc__,
    option("files", nargs="+", type=Path, help="of sandglass verify --json"),
    option("-o", "--output", type=Path, help="the joined file"),
)


if __name__ == "__main__":
    sys.exit(main())
