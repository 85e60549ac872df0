"""The program under test and the small case that its tests use.

SANDGLASS_BINARY in the environment names the program; without it, it is build/release/sandglass.
For a slow one, SANDGLASS_PATIENCE multiplies the time that its commands may take.
"""

import json
import os
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import h5py

from common.program import ROOT
from common.result_file import last_displacement

PATIENCE = float(os.environ.get("SANDGLASS_PATIENCE", "1"))
BINARY = os.environ.get("SANDGLASS_BINARY", str(ROOT / "build" / "release" / "sandglass"))

BLOCK = (Path(__file__).parent / "support/block.toml").read_text()

BARE = BLOCK.partition("[comparison]")[0]  # without a comparison

LIMIT = """
[[expect]]
method = "{method}"
reference = "golden"
figure = "max_relative_error"
below = {below}
reason = "a test"
"""


def dynamic(text, **numbers):
    """A quasi-static case made dynamic. numbers: entries of its table [dynamics]."""
    keys = "".join(f"{key} = {value}\n" for key, value in numbers.items())
    return text.replace('"quasi-static"', '"dynamic"') + "\n[dynamics]\n" + keys


def ran(*command, **options):
    """The outcome of any command, with its output. options: for subprocess.run."""
    words = [str(word) for word in command]
    return subprocess.run(words, capture_output=True, text=True, **options)


def sandglass(*arguments, program=BINARY, code=None, message=(), **options):
    """Runs the program; returns its outcome with its output.

    code: the expected exit code. message: one or more texts that its errors must contain.
    """
    done = ran(program, *arguments, timeout=120 * PATIENCE, **options)
    assert code in (None, done.returncode), f"{done.returncode}: {done.stdout}{done.stderr}"
    for text in [message] if isinstance(message, str) else message:
        assert text in done.stderr, f"{text!r} is not in {done.stderr!r}"
    return done


def documented(command, *more, **options):
    """(outcome, document) of sandglass() with --json. command: its words in one text."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "document.json"
        outcome = sandglass(*command.split(), *more, "--json", file, **options)
        return outcome, json.loads(file.read_text())


def catches_interrupts(process):
    """Whether a process handles Ctrl-C, according to the kernel."""
    for line in Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("SigCgt:"):
            return bool(int(line.split()[1], 16) >> (signal.SIGTERM - 1) & 1)  # watched last
    return False


def interrupted(*arguments, sent=signal.SIGINT, once=lambda: True, **options):
    """Runs the program and sends it a signal once it handles it and a condition holds.

    Returns its exit code and its errors.
    """
    command = [BINARY, *map(str, arguments)]
    pipes = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, **pipes, **options) as process:
        while process.poll() is None and not (once() and catches_interrupts(process)):
            time.sleep(0.002)
        process.send_signal(sent)
        _, errors = process.communicate(timeout=60 * PATIENCE)
    return process.returncode, errors


def methods():
    """The names of all methods, from the program itself."""
    return [line.split()[0] for line in sandglass("methods").stdout.splitlines()]


def write_golden(case, **changed):
    """Stores the answer of mean dilatation as a case's golden; `changed` replaces attributes."""
    result = case.parent / "for-golden.h5"
    assert sandglass("run", case, "--method", "tl-mean-dilatation", "-o", result).returncode == 0
    with h5py.File(case.parent / "golden.h5", "w") as golden, h5py.File(result) as source:
        golden["displacement"] = last_displacement(result)
        for name in ("case_hash", "mesh_hash"):
            golden.attrs[name] = changed.get(name, source.attrs[name])
