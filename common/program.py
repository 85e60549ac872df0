"""The solver's program and others: where it is, and what it prints."""

import os
import subprocess
from pathlib import Path

from common.errors import ComputationError, InputError

ROOT = Path(__file__).resolve().parent.parent
CASES = ROOT / "cases"


def binary():
    """The absolute Path of the solver: SANDGLASS_BINARY, else build/release/sandglass of this tree.

    Raises InputError where there is none.
    """
    path = Path(os.environ.get("SANDGLASS_BINARY", ROOT / "build/release/sandglass")).resolve()
    if not os.access(path, os.X_OK) or path.is_dir():
        raise InputError(
            f"{path}: no program there; `ci/build release sandglass_cli` makes it, "
            "SANDGLASS_BINARY names another"
        )
    return path


def output_of(*command, allowed=(0,), **options):
    """What a program of the house prints; words may be paths, options are subprocess.run's.

    Raises InputError where it cannot be run or ends with exit code 2, ComputationError where it
    ends with another one that is not allowed.
    """
    words = [str(word) for word in command]
    try:
        done = subprocess.run(words, capture_output=True, text=True, **options)
    except OSError as error:
        raise InputError(f"{words[0]}: cannot be run: {error.strerror}") from error
    if done.returncode not in allowed:
        told = (done.stderr.strip().splitlines() or ["it told no reason"])[-1]
        kind = InputError if done.returncode == 2 else ComputationError
        text = f"`{' '.join(words)}` ended with {done.returncode}: {told.removeprefix('error: ')}"
        raise kind(text)
    return done.stdout
