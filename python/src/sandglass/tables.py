"""The tables of a case as classes, made from the declarations of the solver.

A law, a generator or a kind of force that the solver gains is a class here without a line of
Python. This file needs nothing but the compiled module: the build also runs it to write
tables.pyi.
"""

import difflib
import inspect
import json

import _sandglass

_TYPES = {"number": "float", "integer": "int", "text": "str", "flag": "bool", "word": "str"}


class Table:
    """A table of a case file: a mesh generator, a law, a load, settings. Parameters are attributes.

    Parameters are keywords; `None` means the default. Numbers may be NumPy's, lists may be arrays.
    Raises TypeError for a parameter that does not exist, is missing or cannot be written in a case
    file; values are checked by the solver when it takes the case.
    """

    _declared = {}  # the declaration of the table
    _keys = {}  # the declarations of its keys, by their names

    def __init__(self, **values):
        object.__setattr__(self, "_values", {})
        for key, value in values.items():
            setattr(self, key, value)
        missing = [k for k, d in self._keys.items() if d["required"] and k not in self._values]
        if missing:
            raise TypeError(f"{self._name()}: {missing[0]} is missing; {self._known()}")

    def __setattr__(self, key, value):
        if key not in self._keys:
            raise TypeError(f"{self._name()}: '{key}' is not a parameter; {self._known(key)}")
        if value is None:
            if self._keys[key]["required"]:
                raise TypeError(f"{self._name()}: {key} is missing; it must be given")
            self._values.pop(key, None)
        else:
            self._values[key] = plain(f"{self._name()}: {key}", value)

    def __getattr__(self, key):
        if key in self._keys:
            return self._values.get(key)
        raise AttributeError(f"{self._name()}: '{key}' is not a parameter; {self._known(key)}")

    def __getstate__(self):
        return self._values

    def __setstate__(self, values):
        object.__setattr__(self, "_values", values)

    def __eq__(self, other):
        return type(self) is type(other) and self._values == other._values

    __hash__ = None

    def __repr__(self):
        values = ", ".join(f"{key}={value!r}" for key, value in self._values.items())
        return f"{self._name()}({values})"

    def _toml(self):
        """The keys of the table in a case file."""
        choice = {self._declared["choice_key"]: self._declared["choice"]}
        return (choice if self._declared["choice"] else {}) | self._values

    @classmethod
    def _name(cls):
        return f"sg.{cls.__name__}"

    @classmethod
    def _known(cls, key=""):
        near = difflib.get_close_matches(key, cls._keys, 1) if key else []
        return (
            f"did you mean '{near[0]}'?" if near else f"its parameters are {', '.join(cls._keys)}"
        )


def plain(name, value):
    """A value as bool, int, float, str, list or dict; raises TypeError that calls it `name`."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, dict):
        for key in value:
            if not isinstance(key, str):
                raise TypeError(f"{name}: the key {key!r} must be a text")
        return {key: plain(f"{name}.{key}", entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(name, entry) for entry in value]
    if isinstance(value, int) and not isinstance(value, bool) and not -(2**63) <= value < 2**63:
        raise TypeError(f"{name} = {value} must be in [-2^63, 2^63)")
    if isinstance(value, str) and any("\ud800" <= letter <= "\udfff" for letter in value):
        raise TypeError(f"{name} must be a text that UTF-8 can hold")
    if isinstance(value, (bool, int, float, str)):
        return value
    raise TypeError(
        f"{name} must be a number, a text, a list or a table, but is a {type(value).__name__}"
    )


def _class_name(declared):
    words = (declared["choice"] or declared["table"]).replace("-", "_").split("_")
    return "".join(word[:1].upper() + word[1:] for word in words)


def _annotation(cls, key):
    if cls._declared["table"] == "material" and key["type"] == "number" and key["count"] == 1:
        return "float | Sequence[float] | NDArray[Any]"  # it may differ from element to element
    kind = _TYPES.get(key["type"], "dict[str, object]")
    if key["count"] != 1:
        kind = f"Sequence[{kind}]" if key["type"] == "table" else "Sequence[float] | NDArray[Any]"
    # The strength of a control may be "auto", and an axis may be a vector.
    return {"kappa": "float | str", "axis": "str | Sequence[float]"}.get(key["name"], kind)


def _described(key):
    unit = "" if key["unit"] in ("-", "") else f" in {key['unit']}"
    rule = f", {key['allowed']}" if key["allowed"] else ""
    shape = {0: ", a list", 1: ""}.get(key["count"], f", shape ({key['count']},)")
    standard = f"; default: {key['standard']}" if key["standard"] else ""
    optional = "" if key["required"] or standard else "; optional"
    kind = f"{key['type']}{unit}{shape}{rule}{standard}{optional}"
    return f"    `{key['name']}`: {kind}. {key['meaning']}"


def _class_of(declared):
    keys = {key["name"]: key for key in declared["keys"]}
    lines = [declared["summary"][:1].upper() + declared["summary"][1:] + ".", ""]
    lines += [_described(key) for key in keys.values()]
    parameter = inspect.Parameter
    parameters = [
        parameter(name, parameter.KEYWORD_ONLY, **({} if key["required"] else {"default": None}))
        for name, key in keys.items()
    ]
    members = {
        "_declared": declared,
        "_keys": keys,
        "__doc__": "\n".join(lines).replace("|", r"\|"),  # in reST |x| is a substitution
        "__module__": "sandglass",
        "__signature__": inspect.Signature(parameters),
    }
    return type(_class_name(declared), (Table,), members)


CLASSES = {cls.__name__: cls for cls in map(_class_of, _sandglass.case_tables())}
globals().update(CLASSES)
__all__ = ["Table", *CLASSES]


def class_for(table, choice=""):
    """The class of a table, such as "pressure", and of its choice, such as a law; else None."""
    for cls in CLASSES.values():
        if cls._declared["table"] == table and cls._declared["choice"] == choice:
            return cls
    return None


def stub_text():
    """The text of tables.pyi."""
    text = '"""Written by the build from the declarations of the solver."""\n\n'
    text += "from collections.abc import Sequence\nfrom typing import Any\n\n"
    text += "from numpy.typing import NDArray\n\n"
    text += f"__all__ = {json.dumps(__all__)}\nCLASSES: dict[str, type[Table]]\n\n"
    text += "class Table:\n    def __init__(self, **values: object) -> None: ...\n\n"
    text += "def plain(name: str, value: object) -> Any: ...\ndef stub_text() -> str: ...\n"
    text += "def class_for(table: str, choice: str = ...) -> type[Table] | None: ...\n"
    for name, cls in CLASSES.items():
        text += f"\nclass {name}(Table):\n"
        fields, arguments = "", ""
        for key in cls._keys.values():
            kind = _annotation(cls, key) + ("" if key["required"] else " | None")
            fields += f"    {key['name']}: {kind}\n"
            arguments += f", {key['name']}: {kind}" + ("" if key["required"] else " = ...")
        text += fields + f"    def __init__(self, *{arguments}) -> None: ...\n"
    return text
