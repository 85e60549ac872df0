#!/usr/bin/python3
"""The sources that clang-tidy checks after a change.

    ci/affected.py SOURCE...    prints these sources, and on stderr the reason

A change is any difference from the revision in .ci/linted, where `ci/lint all` found nothing.
Every changed source is checked. A finding in a header shows up in any source that includes it: for
changed headers that no changed source includes, as few others are added as include them all.
Effects of a changed header on the other sources that include it are left to `ci/lint all`. All
sources are checked if that revision is not in this clone (a shallow one). If the checks themselves
changed, `ci/lint all` must find nothing first, which takes up to an hour: exit status 1.
"""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("solver", "suite", ".")  # the folders from which includes are written
CHECKS = {".clang-tidy", "ci/tidy.py"}


def changed_files(root):
    """(revision, paths that differ from it, those that git does not know yet included).

    Paths are None where the revision in .ci/linted is not in the clone.
    """

    def git(*words):
        done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True)
        return done.stdout.splitlines() if done.returncode == 0 else None

    revision = (root / ".ci/linted").read_text().strip()
    known = git("diff", "--name-only", "--no-renames", revision, "--")
    new = git("ls-files", "--others", "--exclude-standard")
    return revision, None if known is None else {*known, *new}


def reached(root, source):
    """The headers of the project that a source includes, directly or through others: paths."""
    found, waiting = set(), [source]
    while waiting:
        file = waiting.pop()
        for name in re.findall(r'^#include "(.+)"', (root / file).read_text(), re.MULTILINE):
            places = (Path(folder, name) for folder in (Path(file).parent, *FOLDERS))
            header = next((str(place) for place in places if (root / place).exists()), None)
            if header and header not in found:
                found.add(header)
                waiting.append(header)
    return found


def affected(root, sources, changed):
    """The changed sources, and as few others as include the remaining changed headers."""
    headers = {source: reached(root, source) & changed for source in sources}
    found = [source for source in sources if source in changed]
    left = set().union(*headers.values()).difference(*(headers[source] for source in found))
    while left:
        found.append(max(sources, key=lambda source: len(headers[source] & left)))
        left -= headers[found[-1]]
    return found


def chosen(root, sources):
    """(the sources to check, why). Exits if the checks changed."""
    revision, changed = changed_files(root)
    if changed is None:
        return sources, f"{revision[:12]}, the revision in .ci/linted, is not in this clone"
    if checks := sorted(CHECKS & changed):
        sys.exit(
            f"ci/lint: {', '.join(checks)} changed since {revision[:12]}: run `ci/lint all`,"
            " and commit .ci/linted, which it writes"
        )
    return affected(root, sources, changed), f"what changed since {revision[:12]}"


def main(*sources):
    """Prints the sources to check, and on stderr their number and the reason."""
    found, why = chosen(ROOT, sources)
    print(f"clang-tidy of {len(found)} of {len(sources)} sources: {why}", file=sys.stderr)
    print(*found, sep="\n", end="\n" if found else "")


if __name__ == "__main__":
    main(*sys.argv[1:])
