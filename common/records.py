"""Validated reading of documents: errors name the file and the missing or mistyped key."""

import dataclasses
import math
import typing

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


def entries(where, record, key):
    """(where, object) for each entry of a required list of objects; where is like "FILE: key[0]".

    Raises InputError.
    """
    found = []
    for number, one in enumerate(entry(where, record, key, list)):
        found.append((f"{_name(where, key)}[{number}]", one))
        if not isinstance(one, dict):
            raise InputError(f"{found[-1][0]} = {one!r} must be an object")
    return found


def entry(where, record, key, kind, none_allowed=False):
    """A required value of an object, of one of the kinds in WORDS; None where that is allowed.

    where: the file, or the file and the object's own key. Raises InputError.
    """
    name = _name(where, key)
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


def _name(where, key):
    """The full name of a key of a file or of an object in it."""
    return f"{where}.{key}" if ": " in str(where) else f"{where}: {key}"


def as_dataclass(kind, where, record, **known):
    """An object as a dataclass; a field's key is its name unless `key` gives another.

    Fields are texts, numbers (float: any), lists, objects or dataclasses, or one of these | None.
    known: values of fields that are not read. Raises InputError.
    """
    for field in dataclasses.fields(kind):
        if field.name in known:
            continue
        of, *others = typing.get_args(field.type) or (field.type,)
        name, nested = field.metadata.get("key", field.name), dataclasses.is_dataclass(of)
        of_json = dict if nested else NUMBER if of is float else of
        value = entry(where, record, name, of_json, none_allowed=bool(others))
        if nested and value is not None:
            value = as_dataclass(of, _name(where, name), value)
        known[field.name] = value
    return kind(**known)


def key(name):
    """A field of a dataclass whose key in documents differs from its name."""
    return dataclasses.field(metadata={"key": name})


def facts(document):
    """A document's metadata: name -> text, for all values that are neither lists nor objects."""
    return {k: str(v) for k, v in document.items() if not isinstance(v, (list, dict, type(None)))}
