"""Calling the C++ program for the mesh of a case."""

import os
import subprocess
from pathlib import Path

from errors import InputError

REPOSITORY = Path(__file__).resolve().parent.parent
CASES = REPOSITORY / "cases"


def make_mesh(case_path, output, name=None):
    """Run `sandglass mesh CASE -o OUTPUT` with the binary of this checkout.

    name: of the case, where the file at case_path has variants.
    The binary is build/release/sandglass, or the one that SANDGLASS_BINARY names.
    Raises InputError when the binary is missing or fails.
    """
    binary = Path(os.environ.get("SANDGLASS_BINARY", REPOSITORY / "build/release/sandglass"))
    case = Path(case_path).resolve().parent / name if name else case_path
    command = [str(binary.resolve()), "mesh", str(case), "-o", str(output)]
    try:
        done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True)
    except OSError as error:
        raise InputError(
            f"{binary}: cannot run the solver: {error.strerror}; build it (cmake --build --preset "
            "release) or name it in SANDGLASS_BINARY"
        ) from error
    if done.returncode:
        raise InputError(f"`{' '.join(command)}` ended with {done.returncode}: {done.stderr}")
