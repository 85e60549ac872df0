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

# `ci/site` puts these beside the documentation.
PUBLISHED = ("report/index.html",)


class Page(HTMLParser):
    """The anchors and links of a page, and its text without that of scripts."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.text, self.hidden = set(), [], "", False
        self.feed(path.read_text())
        self.text = " ".join(self.text.split())

    def handle_starttag(self, tag, attributes):
        """Keeps what a tag names and where it leads."""
        named = dict(attributes)
        self.anchors |= {named[key] for key in ("id", "name") if named.get(key)}
        self.links += [named[key] for key in ("href", "src") if named.get(key)]
        self.hidden = tag in ("script", "style")

    def handle_endtag(self, tag):
        """Text goes on after a script."""
        self.hidden = self.hidden and tag not in ("script", "style")

    def handle_data(self, data):
        """Keeps text."""
        self.text += "" if self.hidden else data


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
            if not place or place in PUBLISHED:
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
