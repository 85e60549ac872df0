"""Reading documents with care: what is missing or of the wrong kind is said with file and key."""

import math

from common.errors import InputError

NUMBER = (int, float)
WORDS = {
    bool: "true or false",
    dict: "an object",
    int: "a whole number",
    list: "a list",
    NUMBER: "a number",
    str: "a text",
}


def entries(path, document, key):
    """(where, entry) of each entry of a required list of objects, where as in "FILE: key[0]".

    Raises InputError.
    """
    found = entry(path, document, key, list)
    for number, one in enumerate(found):
        if not isinstance(one, dict):
            raise InputError(f"{path}: {key}[{number}] = {one!r} must be an object")
    return [(f"{path}: {key}[{number}]", one) for number, one in enumerate(found)]


def entry(where, record, key, kind, none_allowed=False):
    """A required value of an object, of a kind out of WORDS; None where that is allowed.

    where: the file, or the file and the object's own key. Raises InputError.
    """
    name = f"{where}.{key}" if ": " in str(where) else f"{where}: {key}"
    if key not in record:
        raise InputError(f"{name} is missing; it must be {WORDS[kind]}")
    value = record[key]
    if value is None and none_allowed:
        return None
    if not isinstance(value, kind) or (kind is not bool and isinstance(value, bool)):
        raise InputError(f"{name} = {value!r} must be {WORDS[kind]}{' or null' * none_allowed}")
    if isinstance(value, float) and not math.isfinite(value):
        raise InputError(f"{name} = {value!r} must be finite")
    return value


def facts(document):
    """What a document says about its making: name -> text, all that is neither list nor object."""
    return {k: str(v) for k, v in document.items() if not isinstance(v, (list, dict, type(None)))}
