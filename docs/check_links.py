"""Looks whether every link within a folder of HTML leads to a place that is there.

    /usr/bin/python3 docs/check_links.py FOLDER

Links out of the folder's pages to other sites are left to `ci/docs-site --links`. Exit codes: 0 all
lead somewhere; 1 some do not, each named with its page and the rule; 2 wrong use.
"""

import argparse
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from common.command import exit_code  # noqa: E402
from common.errors import InputError  # noqa: E402

# What `ci/site` puts beside the documentation, and where.
PUBLISHED = {"build/report/index.html": "report/index.html"}


class Page(HTMLParser):
    """The anchors and links of a page, its text without that of scripts, and its blocks of code."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.text, self.code, self.inside = set(), [], "", "", ""
        self.feed(path.read_text())
        self.text, self.code = (" ".join(text.split()) for text in (self.text, self.code))

    def handle_starttag(self, tag, attributes):
        """Keeps what a tag names and where it leads."""
        named = dict(attributes)
        self.anchors |= {named[key] for key in ("id", "name") if named.get(key)}
        self.links += [named[key] for key in ("href", "src") if named.get(key)]
        if tag in ("script", "style", "pre"):
            self.inside = tag

    def handle_endtag(self, tag):
        """Leaves a script or a block of code."""
        self.inside = "" if tag == self.inside else self.inside

    def handle_data(self, data):
        """Keeps text."""
        self.text += "" if self.inside in ("script", "style") else data
        self.code += data if self.inside == "pre" else ""


def read(folder):
    """Path in a folder -> Page. Raises InputError where there is none."""
    pages = {str(path.relative_to(folder)): Page(path) for path in sorted(folder.rglob("*.html"))}
    if "index.html" not in pages:
        raise InputError(f"{folder}: index.html is not there; `bash ci/docs-site` makes it")
    return pages


def target(page, link):
    """(path in the folder, anchor) of a link on a page, or none for one to another site."""
    parts = urlsplit(link)
    if parts.scheme or parts.netloc:
        return None
    path = unquote(parts.path)
    place = page if not path else str((Path("/") / page).parent.joinpath(path).resolve())[1:]
    return place, unquote(parts.fragment)


def broken(folder):
    """Messages about the links that lead nowhere."""
    pages = read(folder)
    for name, page in pages.items():
        for link in page.links:
            place, anchor = target(name, link) or ("", "")
            if not place or place in PUBLISHED.values():
                continue
            if not (folder / place).is_file():
                yield f"{name}: link '{link}': {place} is not there; a link must lead to a file"
            elif anchor and place in pages and anchor not in pages[place].anchors:
                yield f"{name}: link '{link}': {place} has no place '{anchor}'"


def check(options):
    """Prints what is broken. Returns the exit code."""
    found = list(broken(options.folder.resolve()))
    for message in found:
        print(f"error: {message}", file=sys.stderr)
    return 1 if found else 0


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    return exit_code(check, parser.parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
