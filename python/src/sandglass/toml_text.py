"""Tables as the text of a case file."""

import json
import re


def _value(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(
        value, str
    ):  # of JSON's escapes, TOML lacks none that occur, but one must be added
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, dict):
        entries = ", ".join(f"{_key(key)} = {_value(entry)}" for key, entry in value.items())
        return "{ " + entries + " }" if entries else "{}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    return repr(
        value
    )  # integers, and numbers with as many digits as they need, inf and nan among them


def _key(key):
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _value(key)


def toml_text(tables):
    """The text of a dict of tables and of lists of tables, [name] and [[name]], in their order."""
    parts = []
    for name, table in tables.items():
        several = isinstance(table, list)
        head = f"[[{_key(name)}]]" if several else f"[{_key(name)}]"
        for each in table if several else [table]:
            keys = [f"{_key(key)} = {_value(value)}" for key, value in each.items()]
            parts.append("\n".join([head, *keys]) + "\n")
    return "\n".join(parts)


def keys_text(table):
    """The lines of the keys of one table."""
    return "".join(f"{_key(key)} = {_value(value)}\n" for key, value in table.items())
