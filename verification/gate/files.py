"""Input that is refused with a reason, and files that appear whole."""

import json
import os
import tempfile
from pathlib import Path


class InputError(Exception):
    """Bad usage or input: file or key, value, rule, what is allowed. Exit code 2."""


class ComputationError(Exception):
    """The solver failed. Exit code 3."""


def read_json(path):
    """The object in a JSON file, a dict. Raises InputError."""
    try:
        document = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot read: {error.strerror}") from error
    except ValueError as error:
        raise InputError(f"{path}: not a JSON file: {error}") from error
    if not isinstance(document, dict):
        raise InputError(f"{path}: an object is required, not {type(document).__name__}")
    return document


def write_whole(path, text):
    """Writes a text to a temporary file beside `path` and renames it. Raises InputError."""
    path = Path(path)
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(temporary, 0o644)  # mkstemp makes it readable by its owner only
        os.replace(temporary, path)
    except OSError as error:
        raise InputError(f"{path}: cannot write: {error.strerror}") from error
    finally:
        if temporary and os.path.exists(temporary):
            os.unlink(temporary)
