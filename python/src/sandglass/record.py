"""Results of commands: the fields of their JSON, as attributes."""

import json
import types


class Record(types.SimpleNamespace):
    """A result with the fields that the command writes with `--json`, as attributes.

    Missing figures are None; `vars(record)` is a dict. In a notebook, `repr` shows short fields as
    they are and lists of records by their number and fields.
    """

    def __repr__(self):
        return _block("Record", vars(self).items(), "")


def record_of(text):
    """The value of a JSON text, whose objects are records, or dicts if a key is no identifier."""

    def made(fields):
        if all(key.isidentifier() for key in fields):
            return Record(**fields)
        return fields

    return json.loads(text, object_hook=made)


def _block(name, fields, indent):
    lines = [f"{indent}  {key}={_shown(value, indent + '  ')},\n" for key, value in fields]
    return f"{name}(\n{''.join(lines)}{indent})" if lines else f"{name}()"


def _shown(value, indent):
    if isinstance(value, Record):
        short = ", ".join(f"{key}={_shown(each, indent)}" for key, each in vars(value).items())
        if len(short) + len(indent) < 80 and "\n" not in short:
            return f"Record({short})"
        return _block("Record", vars(value).items(), indent)
    if isinstance(value, list) and value and isinstance(value[0], Record):
        if len(value) == 1:
            return f"[{_shown(value[0], indent)}]"
        return f"[{len(value)} records of {', '.join(vars(value[0]))}]"
    if isinstance(value, float):
        return f"{value:.4g}"
    text = repr(value)
    return text if "\n" not in text else f"<sg.{type(value).__name__}>"
