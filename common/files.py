"""Reading JSON and TOML files, and writing files atomically."""

import json
import os
import tempfile
import tomllib
from contextlib import contextmanager
from pathlib import Path

from common.errors import InputError


def read_json(path, command=""):
    """The object in a JSON file, a dict. Raises InputError.

    command: makes such a file; named in the message if the file cannot be read.
    """
    document = _parsed(path, json.loads, "JSON", command)
    if not isinstance(document, dict):
        raise InputError(f"{path}: must be an object, not {type(document).__name__}")
    return document


def read_toml(path):
    """The tables of a TOML file, a dict. Raises InputError."""
    return _parsed(path, tomllib.loads, "TOML")


def _parsed(path, parse, language, command=""):
    """The result of parse() for the text of a file. Raises InputError."""
    try:
        return parse(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        hint = f"; make it with {command}" if command else ""
        raise InputError(f"{path}: cannot be read: {error.strerror}{hint}") from error
    except ValueError as error:
        raise InputError(f"{path}: not a {language} file: {error}") from error


def require_writable(path):
    """Raises InputError unless a file can be written at `path`. To be called before long work."""
    folder = Path(path).resolve().parent
    if not folder.is_dir():
        raise InputError(f"{path}: cannot be written: the folder {folder} does not exist")
    if Path(path).is_dir() or not os.access(folder, os.W_OK):
        raise InputError(f"{path}: cannot be written: must be a file in a writable folder")


@contextmanager
def writing(path):
    """Turns an OSError within the block into an InputError about its file, or about `path`."""
    try:
        yield
    except OSError as error:
        place, reason = error.filename or path, error.strerror or error
        raise InputError(f"{place}: cannot be written: {reason}") from error


@contextmanager
def new_file(path):
    """The Path of an empty temporary file, which replaces `path` when the block ends.

    If the block fails, `path` is left as it was and the temporary file is removed. Raises
    InputError if the file cannot be written.
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
    """Writes a text file atomically. Raises InputError."""
    with new_file(path) as file:
        file.write_text(text, encoding="utf-8")


def write_json(path, document):
    """Writes a JSON file atomically. Raises InputError, or ValueError for NaN and infinity."""
    write_whole(path, json.dumps(document, indent=1, allow_nan=False) + "\n")
