"""JSON and TOML files that are read, and files that appear whole or not at all."""

import json
import os
import tempfile
import tomllib
from contextlib import contextmanager
from pathlib import Path

from common.errors import InputError


def read_json(path, command=""):
    """The object in a JSON file, a dict. Raises InputError.

    command: what makes such a file, for the message where there is none.
    """
    document = _parsed(path, json.loads, "JSON", command)
    if not isinstance(document, dict):
        raise InputError(f"{path}: must be an object, not {type(document).__name__}")
    return document


def read_toml(path):
    """The tables of a TOML file, a dict. Raises InputError."""
    return _parsed(path, tomllib.loads, "TOML")


def _parsed(path, parse, language, command=""):
    """What parse() makes of the text of a file. Raises InputError."""
    try:
        return parse(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        hint = f"; make it with {command}" if command else ""
        raise InputError(f"{path}: cannot be read: {error.strerror}{hint}") from error
    except ValueError as error:
        raise InputError(f"{path}: not a {language} file: {error}") from error


def require_writable(path):
    """Raises InputError unless a file can be written at `path`: asked before the long work."""
    folder = Path(path).resolve().parent
    if not folder.is_dir():
        raise InputError(f"{path}: cannot be written: the folder {folder} does not exist")
    if Path(path).is_dir() or not os.access(folder, os.W_OK):
        raise InputError(f"{path}: cannot be written: must be a file in a writable folder")


@contextmanager
def writing(path):
    """What fails while files are written within is an InputError about them, or about `path`."""
    try:
        yield
    except OSError as error:
        place, reason = error.filename or path, error.strerror or error
        raise InputError(f"{place}: cannot be written: {reason}") from error


@contextmanager
def new_file(path):
    """The Path of an empty file that takes the place of `path` when all has been written to it.

    Where something fails within, what stood at `path` stays and nothing else is left. Raises
    InputError where it cannot be written.
    """
    place, temporary = Path(path).resolve(), None
    try:
        handle, name = tempfile.mkstemp(dir=place.parent, prefix=f".{place.name}.")
        os.close(handle)
        temporary = Path(name)
        yield temporary
        temporary.chmod(0o644)  # mkstemp makes it readable by its owner only
        os.replace(temporary, place)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        if temporary:
            temporary.unlink(missing_ok=True)


def write_whole(path, text):
    """Writes a text as a new file. Raises InputError."""
    with new_file(path) as file:
        file.write_text(text, encoding="utf-8")


def write_json(path, document):
    """Writes a document as a new JSON file. Raises InputError, ValueError for what JSON lacks."""
    write_whole(path, json.dumps(document, indent=1, allow_nan=False) + "\n")
