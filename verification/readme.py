"""READMEs as programs: their steps are taken and their commands run as they stand, in a copy.

What counts of a document, from its top down:
  a file     "New file `PATH`:" or "Save this as `PATH`:", then a code block, its whole text
  a change   "..., in `PATH`:", then code blocks (diff): lines with "-" or " " before them are found
             as they stand, once, and those with "+" or " " take their place
  a command  a line indented by four outside of code blocks, without its comment

    /usr/bin/python3 verification/readme.py TREE DOCUMENT...

copies the project to TREE and takes the steps of the documents there. What they add can then be
built and run as they say.
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
    """A file, a change or a command of a document, under its heading of second order."""

    kind: str  # file, change or command
    heading: str
    text: str
    path: str = ""


def parts(document):
    """The Parts of a Markdown text in their order."""
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
    """The commands of a Markdown text in their order."""
    return [part.text for part in parts(document) if part.kind == "command"]


def inline(document):
    """What stands between single backquotes, code blocks left out."""
    text = re.sub(r"^```.*?^```$", "", document, flags=re.MULTILINE | re.DOTALL)
    return [re.sub(r"\s+", " ", code) for code in re.findall(r"`([^`]+)`", text)]


def changed(text, change):
    """A text with the lines of a change in place of those that it names, which are there once."""
    lines = change.splitlines(keepends=True)
    old, new = ("".join(line[1:] for line in lines if line[0] in " " + sign) for sign in "-+")
    if text.count(old) != 1:
        raise ValueError(f"there {text.count(old)} times, not once:\n{old}")
    return text.replace(old, new)


def take(part, tree):
    """Makes the file or the change of a Part in a tree. Raises ValueError where it does not fit."""
    file = tree / part.path
    if file.exists() == (part.kind == "file"):
        raise ValueError(f"{part.path} is {'there already' if file.exists() else 'not there'}")
    file.write_text(changed(file.read_text(), part.text) if part.kind == "change" else part.text)


def take_steps(document, tree):
    """Takes all steps of a Markdown text in a tree. Returns the files that are new or changed."""
    steps = [part for part in parts(document) if part.kind != "command"]
    for step in steps:
        take(step, tree)
    return list(dict.fromkeys(step.path for step in steps))


def copy(tree):
    """Copies the project, without what is built and what git keeps, to a folder that it makes."""
    left_out = shutil.ignore_patterns("build", ".git", "__pycache__", ".pytest_cache")
    return shutil.copytree(ROOT, tree, ignore=left_out)


# Parses the options of a script, as its own parser does, and ends where its work would begin.
PARSE_ONLY = """
import argparse, os, runpy, sys
real = argparse.ArgumentParser.parse_args
def parse_only(self, *arguments, **options):
    real(self, *arguments, **options)
    print("parsed", flush=True)
    os._exit(0)
argparse.ArgumentParser.parse_args = parse_only
sys.argv = sys.argv[1:]
if sys.argv[0] == "-m":
    sys.argv = sys.argv[1:]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
else:
    sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))
    runpy.run_path(sys.argv[0], run_name="__main__")
"""


def not_taken(command, binary):
    """Why a tool of the project would not take a command; an empty text where it would.

    Python scripts parse their options; shell scripts that hand all over to one as well, else their
    opening comment must know the words; the program gets a method that it refuses once all is read.
    """
    words = [word for word in shlex.split(command) if not re.match(r"[A-Z_]+=", word)]
    if words[0].endswith("sandglass"):
        done = _run([binary, *words[1:], "--methods", "no-such-method"])
        return "" if "'no-such-method' is not known" in done.stderr else done.stderr or done.stdout
    if words[0] in ("bash", "/usr/bin/python3"):
        words = words[1:]
    if words[:2] == ["-m", "pytest"]:
        absent = [word for word in words[2:] if "/" in word and not (ROOT / word).exists()]
        return f"{absent} is not there" if absent else ""
    if "/" not in words[0]:
        return "" if shutil.which(words[0]) else f"{words[0]} is not there"
    script = ROOT / words[0]
    if not script.is_file():
        return f"{words[0]} is not there"
    if command.startswith(words[0]) and not script.stat().st_mode & 0o100:
        return f"{words[0]} cannot be executed"
    text = script.read_text()
    if "python" not in text.partition("\n")[0] and not words[0].endswith(".py"):
        handed = re.search(r'exec /usr/bin/python3 (.*) "\$@"', text)
        if handed is None:
            opening = re.match(r"(?:#.*\n)+", text)[0]
            usage = rf"{words[0]} (?:\[*[A-Z]|{{}}\b)"  # a placeholder, or the word itself
            unknown = [w for w in words[1:] if not re.search(usage.format(w), opening)]
            unknown += [w for w in words[1:] if w.isalpha() and not re.search(rf"\b{w}\b", text)]
            return f"{words[0]} does not tell of {unknown}" if unknown else ""
        script = handed[1].replace('"', "").replace("$root/", "")
        words = [*script.split(), *words[1:]]
    done = _run(["/usr/bin/python3", "-c", PARSE_ONLY, *words])
    return "" if done.stdout.endswith("parsed\n") and done.returncode == 0 else done.stderr


def _run(command):
    environment = {"PATH": "/usr/bin:/bin", "PYTHONPATH": str(ROOT / "verification")}
    environment["PYTHONDONTWRITEBYTECODE"] = "1"
    return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)


def main(tree, *documents):
    """Copies the project to a new folder and takes the steps of documents there."""
    tree = pathlib.Path(copy(tree))
    for document in documents:
        print(f"{document}:", *take_steps((ROOT / document).read_text(), tree))


if __name__ == "__main__":
    main(*sys.argv[1:])
