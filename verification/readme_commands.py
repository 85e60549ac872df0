"""The commands that READMEs show: indented by four or in a block of sh, outside of other blocks.

Also looks whether a tool takes a command as it is written, without running it.
"""

import re
import shlex
import subprocess

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


def commands(document):
    """The commands of a Markdown text, in its order, without comments, continued lines joined."""
    shell = re.compile(r"^```(?:sh|bash|shell|console)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
    text = shell.sub(lambda block: re.sub("^", "    ", block[1], flags=re.MULTILINE), document)
    text = re.sub(r"^```\w*\n.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r" *\\\n +", " ", text)
    lines = re.findall(r"^ {4,}(\S.*)$", text, re.MULTILINE)
    return [re.sub(r"\s+# .*", "", line).strip() for line in lines]


def inline(document):
    """What stands between single backquotes, code blocks left out."""
    text = re.sub(r"^```.*?^```$", "", document, flags=re.MULTILINE | re.DOTALL)
    return [re.sub(r"\s+", " ", code) for code in re.findall(r"`([^`]+)`", text)]


def not_taken(command, root, binary):
    """Why a tool of the tree would not take a command; an empty text where it would.

    Python scripts parse their options; shell scripts that hand all over to one as well, else their
    opening comment must know the words; the program gets a method that it refuses once all is read.
    """
    words = shlex.split(command)
    if words[0].endswith("sandglass"):
        done = _run([binary, *words[1:], "--methods", "no-such-method"], root)
        return "" if "'no-such-method' is not known" in done.stderr else done.stderr or done.stdout
    if words[0] in ("bash", "/usr/bin/python3"):
        words = words[1:]
    script = root / words[0]
    if not script.is_file():
        return f"{words[0]} is not there"
    if command.startswith(words[0]) and not script.stat().st_mode & 0o100:
        return f"{words[0]} cannot be executed"
    text = script.read_text()
    first = text.partition("\n")[0]
    if "python" not in first and not words[0].endswith(".py"):
        handed = re.search(r'exec /usr/bin/python3 (.*) "\$@"', text)
        if handed is None:
            opening = re.match(r"(?:#.*\n)+", text)[0]
            usage = rf"{words[0]} (?:\[*[A-Z]|{{}}\b)"  # a placeholder, or the word itself
            unknown = [w for w in words[1:] if not re.search(usage.format(w), opening)]
            unknown += [w for w in words[1:] if w.isalpha() and not re.search(rf"\b{w}\b", text)]
            return f"{words[0]} does not tell of {unknown}" if unknown else ""
        words = [*handed[1].split(), *words[1:]]
    done = _run(["/usr/bin/python3", "-c", PARSE_ONLY, *words], root)
    return "" if done.stdout.endswith("parsed\n") and done.returncode == 0 else done.stderr


def _run(command, root):
    environment = {"PATH": "/usr/bin:/bin", "PYTHONPATH": str(root / "verification")}
    environment["PYTHONDONTWRITEBYTECODE"] = "1"
    return subprocess.run(command, cwd=root, env=environment, capture_output=True, text=True)
