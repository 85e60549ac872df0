"""Reading JSON files with care: what is missing or of the wrong kind is said with file and key."""

import json
import math

from sandglass_report.errors import ReportError

NUMBER = (int, float)


def read_document(path, command):
    """The object in a JSON file that `command` makes. Raises ReportError when it is none."""
    try:
        with open(path, encoding="utf-8") as file:
            document = json.load(file)
    except OSError as error:
        raise ReportError(
            f"{path}: cannot read it: {error.strerror}; make it with {command}"
        ) from error
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise ReportError(f"{path}: not a JSON file: {error}") from error
    if not isinstance(document, dict):
        raise ReportError(f"{path}: not a file of {command}: no JSON object")
    return document


def entries(path, document, key):
    """(where, entry) of a required list of the document."""
    if not isinstance(document.get(key), list):
        raise ReportError(f"{path}: {key} is missing or no list: not a file of this solver")
    return [(f"{path}: {key}[{i}]", one) for i, one in enumerate(document[key])]


def entry(where, record, key, kinds, none_allowed=False):
    """A required, checked value of a record; null where allowed. Raises ReportError."""
    if not isinstance(record, dict) or key not in record:
        raise ReportError(f"{where}.{key} is missing; the file comes from another version")
    value = record[key]
    if value is None and none_allowed:
        return None
    if not isinstance(value, kinds) or (bool not in _tuple(kinds) and isinstance(value, bool)):
        wanted = " or ".join(kind.__name__ for kind in _tuple(kinds))
        raise ReportError(f"{where}.{key} = {value!r}: must be {wanted}")
    if isinstance(value, float) and not math.isfinite(value):
        raise ReportError(f"{where}.{key} = {value!r}: must be finite")
    return value


def facts(document):
    """What a document says about its making: name -> text, all that is neither list nor table."""
    return {k: str(v) for k, v in document.items() if not isinstance(v, (list, dict, type(None)))}


def _tuple(kinds):
    return kinds if isinstance(kinds, tuple) else (kinds,)
