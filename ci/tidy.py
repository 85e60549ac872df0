#!/usr/bin/python3
"""clang-tidy with a cache: ccache remembers clean sources, which are not checked again.

    ci/tidy.py BUILD SOURCE...    checks the sources as BUILD/compile_commands.json compiles them

ccache remembers objects, so this file is also the "compiler" that it calls (FLAGS -c SOURCE -o
OBJECT, or -E to hash what is included): one whose object means that clang-tidy found nothing.
Findings are not remembered.
"""

import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
REMEMBERS = {
    "CCACHE_BASEDIR": str(ROOT),  # results of one clone serve the next
    "CCACHE_COMMENTS": "1",  # NOLINT is one
    "CCACHE_COMPILERCHECK": "clang-tidy --version",
    "CCACHE_COMPILERTYPE": "gcc",
    "CCACHE_EXTRAFILES": f"{ROOT / '.clang-tidy'}:{Path(__file__).resolve()}",
}


def check(command, directory):
    """Exit status of clang-tidy for a compile command (words), from the cache if it was 0."""
    compiler, *flags = command
    with tempfile.TemporaryDirectory() as folder:
        flags[flags.index("-o") + 1] = f"{folder}/clean"
        return subprocess.run(
            ["ccache", Path(__file__).resolve(), *flags],
            cwd=directory,
            env=os.environ | REMEMBERS | {"TIDY_PREPROCESSOR": compiler},
        ).returncode


def as_compiler(arguments):
    """Preprocesses, or checks the source and writes the object. Returns the exit status."""
    if "-E" in arguments:
        return subprocess.run([os.environ["TIDY_PREPROCESSOR"], *arguments]).returncode
    clean = arguments[arguments.index("-o") + 1]
    tidy = ["clang-tidy", "--quiet", "--warnings-as-errors=*"]
    tidy += ["--extra-arg=-Wno-unknown-warning-option", arguments[-1], "--", *arguments]
    done = subprocess.run(tidy, stderr=subprocess.PIPE, text=True)
    kept = [line for line in done.stderr.splitlines() if "warnings generated" not in line]
    print(*kept, sep="\n", end="\n" if kept else "", file=sys.stderr)
    if done.returncode == 0:
        Path(clean).write_text("clean\n")  # ccache does not store empty objects
    return done.returncode


def words_of(entry):
    """The words of a compile command without precompiled headers: sources include what they use."""
    words = [
        w for w in shlex.split(entry["command"]) if w not in ("-Winvalid-pch", "-fpch-preprocess")
    ]
    if "-include" in words:
        first = words.index("-include")
        words = words[:first] + words[first + 2 :]
    return words


def commands_in(database):
    """The entry of every source in a database of compile commands; CMake lists only the file that
    includes those that are compiled together."""
    compiled = {}
    for entry in json.loads(database.read_text()):
        file = entry["file"]
        together = (
            re.findall('#include "(.*)"', Path(file).read_text()) if "/Unity/" in file else [file]
        )
        for source in together:
            compiled[source] = entry | {"command": entry["command"].replace(file, source)}
    return compiled


def main(build, *sources):
    """Checks the sources on all cores: 1 where one has a finding or is not compiled, else 0."""
    compiled = commands_in(Path(build) / "compile_commands.json")
    unknown = [source for source in sources if str(Path(source).resolve()) not in compiled]
    if unknown:
        print(f"ci/tidy.py: {build} compiles none of: {' '.join(unknown)}", file=sys.stderr)
        return 1
    chosen = [compiled[str(Path(source).resolve())] for source in sources]
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as cores:
        results = cores.map(lambda e: check(words_of(e), e["directory"]), chosen)
    return int(any(results))


if __name__ == "__main__":
    compiling = "-c" in sys.argv or "-E" in sys.argv
    sys.exit(as_compiler(sys.argv[1:]) if compiling else main(*sys.argv[1:]))
