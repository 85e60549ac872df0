"""Executes READMEs: takes their steps and runs their commands as they stand, in a copy.

The parts of a document, in order:
  a file     "New file `PATH`:" or "Save this as `PATH`:", then a code block with its whole text
  a change   "..., in `PATH`:", then code blocks (diff): lines with "-" or " " before them must
             occur exactly once; those with "+" or " " replace them
  a command  a line indented by four outside of code blocks, without its comment

    /usr/bin/python3 verification/readme.py TREE DOCUMENT...

copies the project to TREE and takes the steps of the documents there. The additions can then be
built and run as the documents say.
"""

import pathlib
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parent.parent
NAMED = re.compile(r"(?:(?P<new>New file|[Ss]ave this as)|, in)\s+`(?P<path>[^`]+)`:")
PART = re.compile(
    r"^## (?P<heading>.*)$"
    rf"|{NAMED.pattern}"
    r"|^```(?P<language>.*)\n(?P<block>(?:.*\n)*?)```$"
    r"|^ {4,}(?P<command>\S(?:.*\\\n)*.*)$",
    re.MULTILINE,
)


@dataclass(frozen=True)
class Part:
    """A file, a change or a command of a document, under its second-level heading."""

    kind: str  # file, change or command
    heading: str
    text: str
    path: str = ""


def parts(document):
    """The Parts of a Markdown text in order."""
    found, heading, named = [], "", None
    for part in PART.finditer(document):
        if part["heading"]:
            heading, named = part["heading"], None
        elif part["path"]:
            named = part
        elif part["command"]:
            command = re.sub(r"\s+# .*", "", re.sub(r" *\\\n +", " ", part["command"])).strip()
            found.append(Part("command", heading, command))
        elif named and (named["new"] or part["language"] == "diff"):
            kind = "file" if named["new"] else "change"
            found.append(Part(kind, heading, part["block"], named["path"]))
            named = None if named["new"] else named
    return found


def commands(document):
    """The commands of a Markdown text in order."""
    return [part.text for part in parts(document) if part.kind == "command"]


def inline(document):
    """The texts between single backquotes outside of code blocks."""
    text = re.sub(r"^```.*?^```$", "", document, flags=re.MULTILINE | re.DOTALL)
    return [re.sub(r"\s+", " ", code) for code in re.findall(r"`([^`]+)`", text)]


def changed(text, change):
    """A text with the lines of a change replaced, which must occur exactly once."""
    lines = change.splitlines(keepends=True)
    old, new = ("".join(line[1:] for line in lines if line[0] in " " + sign) for sign in "-+")
    if text.count(old) != 1:
        raise ValueError(f"there {text.count(old)} times, not once:\n{old}")
    return text.replace(old, new)


def take(part, tree):
    """Makes the file or the change of a Part in a tree. Raises ValueError if it does not fit."""
    file = tree / part.path
    if file.exists() == (part.kind == "file"):
        raise ValueError(f"{part.path} is {'there already' if file.exists() else 'not there'}")
    file.write_text(changed(file.read_text(), part.text) if part.kind == "change" else part.text)


def take_steps(document, tree):
    """Takes all steps of a Markdown text in a tree. Returns the new and changed files."""
    steps = [part for part in parts(document) if part.kind != "command"]
    for step in steps:
        take(step, tree)
    return list(dict.fromkeys(step.path for step in steps))


def copy(tree):
    """Copies the project, without build folders and git's data, to a folder that it makes."""
    left_out = shutil.ignore_patterns("build", ".git", "__pycache__", ".pytest_cache")
    return shutil.copytree(ROOT, tree, ignore=left_out)


def not_taken(command, binary):
    """Why a tool of the project would reject a command; an empty text if it would not.

    Options and plain words of a shell script must occur in the script or in the one that it
    delegates to, those of the program in its help; canonical cases are always accepted.
    """
    words = [word for word in shlex.split(command) if not re.match(r"[A-Z_]+=", word)]
    is_called, plain = words[0] not in ("bash", "/usr/bin/python3"), False
    words = words if is_called else words[1:]
    if words[0].endswith("sandglass"):
        help_of = [binary, words[1], "--help"]
        text = subprocess.run(help_of, capture_output=True, text=True).stdout + words[1]
    elif words[0] == "-m":  # pytest
        absent = [word for word in words if "/" in word and not (ROOT / word).exists()]
        return f"{absent} is not there" if absent else ""
    elif "/" not in words[0]:
        return "" if shutil.which(words[0]) else f"{words[0]} is not there"
    else:
        script = ROOT / words[0]
        if not script.is_file():
            return f"{words[0]} is not there"
        if is_called and not script.stat().st_mode & 0o100:
            return f"{words[0]} cannot be executed"
        text, plain = script.read_text(), script.suffix != ".py"
        for other in re.findall(r'exec /usr/bin/python3 (?:-m )?"?(?:\$root/)?([\w./]+)', text):
            places = (ROOT / other, ROOT / "verification" / other / "__main__.py")
            text += next(place for place in places if place.is_file()).read_text()
    cases = {file.stem for file in (ROOT / "cases").glob("*.toml")}
    asked = [word for word in words[1:] if word[0] == "-" or (plain and word.isalpha())]
    unknown = [
        word
        for word in asked
        if word not in cases and not re.search(rf"(?<![\w-]){word}(?![\w-])", text)
    ]
    return f"{words[0]} does not know {unknown}" if unknown else ""


def main(tree, *documents):
    """Copies the project to a new folder and takes the steps of documents there."""
    tree = pathlib.Path(copy(tree))
    for document in documents:
        print(f"{document}:", *take_steps((ROOT / document).read_text(), tree))


if __name__ == "__main__":
    main(*sys.argv[1:])
