"""Finding the solver's program, and running it and others."""

import os
import subprocess
from pathlib import Path

from common.errors import ComputationError, InputError

ROOT = Path(__file__).resolve().parent.parent
CASES = ROOT / "cases"


def binary():
    """The absolute Path of the solver: SANDGLASS_BINARY, else build/release/sandglass of this tree.

    Raises InputError if it does not exist.
    """
    path = Path(os.environ.get("SANDGLASS_BINARY", ROOT / "build/release/sandglass")).resolve()
    if not os.access(path, os.X_OK) or path.is_dir():
        raise InputError(
            f"{path}: no program there; build it with `ci/build release sandglass_cli`, or set "
            "SANDGLASS_BINARY to another"
        )
    return path


def output_of(*command, allowed=(0,), **options):
    """The standard output of a command; words may be paths, options are those of subprocess.run.

    Raises InputError if it cannot be run or ends with exit code 2, and ComputationError if it ends
    with any other exit code that is not allowed.
    """
    words = [str(word) for word in command]
    try:
        done = subprocess.run(words, capture_output=True, text=True, **options)
    except OSError as error:
        raise InputError(f"{words[0]}: cannot be run: {error.strerror}") from error
    if done.returncode not in allowed:
        reason = (done.stderr.strip().splitlines() or ["it gave no reason"])[-1]
        kind = InputError if done.returncode == 2 else ComputationError
        text = f"`{' '.join(words)}` ended with {done.returncode}: {reason.removeprefix('error: ')}"
        raise kind(text)
    return done.stdout
