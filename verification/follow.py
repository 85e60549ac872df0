"""Follows the instructions of a README literally: its code blocks are new files and changed lines.

A step names its file, "New file `PATH`:" or "..., in `PATH`:", and code blocks follow: the whole
text of a new file, or changes (diff): lines with "-" or " " before them are found as they stand,
and those with "+" or " " take their place.

    /usr/bin/python3 verification/follow.py DOCUMENT HEADING TREE
"""

import pathlib
import re
import sys

STEP = re.compile(
    r"(?P<kind>New file|, in)\s+`(?P<path>[^`]+)`:|^```(?P<language>\w+)\n(?P<text>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)


def section(document, heading):
    """The text under a second-level heading."""
    found = re.search(rf"^## {re.escape(heading)}\n(.*?)(?=^## |\Z)", document, re.M | re.S)
    if found is None:
        raise ValueError(f"no heading '## {heading}'")
    return found[1]


def commands(text):
    """The commands that a text shows, indented by four, outside of its code blocks."""
    words = STEP.sub("", text)
    return [line.strip() for line in words.splitlines() if line.startswith("    ")]


def changed(text, change):
    """A text with a change applied; the lines to replace must occur exactly once."""
    lines = change.splitlines(keepends=True)
    old, new = ("".join(line[1:] for line in lines if line[0] in " " + sign) for sign in "-+")
    if text.count(old) != 1:
        raise ValueError(f"there {text.count(old)} times, not once:\n{old}")
    return text.replace(old, new)


def follow(text, tree):
    """Follows the steps of a text in a tree. Returns the new or changed files."""
    touched = []
    for step in STEP.finditer(text):
        if step["path"]:
            new = step["kind"] == "New file"
            file = pathlib.Path(tree) / step["path"]
            if file.exists() == new:
                raise ValueError(f"{step['path']} is {'there already' if new else 'not there'}")
            touched.append(step["path"])
        elif step["language"] == "diff":
            file.write_text(changed(file.read_text(), step["text"]))
        else:
            file.write_text(step["text"])
    return touched


if __name__ == "__main__":
    document, heading, tree = sys.argv[1:]
    print("\n".join(follow(section(pathlib.Path(document).read_text(), heading), tree)))
