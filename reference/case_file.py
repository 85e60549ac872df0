"""Reading the parts of a case file (TOML) that the reference needs: material and displacements."""

import difflib
import math
import tomllib
from dataclasses import dataclass

from errors import InputError
from laws import LAWS, parameters


@dataclass(frozen=True)
class Displacement:
    """An imposed displacement: node set, value (3,) in m, and the components it acts on (0..2)."""

    set_name: str
    value: tuple
    components: tuple


@dataclass(frozen=True)
class Rotation:
    """An imposed rotation: node set, axis (3,) of length one, angle in rad, center, displacement.

    center: a point (3,) of the axis, m, or None for the mean of the set's nodes. displacement: (3,)
    in m, beside the rotation.
    """

    set_name: str
    axis: tuple
    angle: float
    center: tuple | None
    displacement: tuple


@dataclass(frozen=True)
class Force:
    """A dead load on the faces within a node set: total (3,) in N, moment (3,) in N m."""

    set_name: str
    total: tuple
    moment: tuple


@dataclass(frozen=True)
class Case:
    """Name, law, numbers of the law (SI units), what is imposed on a case."""

    name: str
    law: str
    material: dict
    displacements: tuple
    forces: tuple = ()
    rotations: tuple = ()


def read_tables(path):
    """The tables of every case of a file, its variants merged in: name of the case -> dict.

    path: str or Path of a TOML file. A file without [variants] has one case. Raises InputError.
    """
    try:
        with open(path, "rb") as file:
            tables = tomllib.load(file)
    except OSError as error:
        raise InputError(f"{path}: cannot read the case file: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not a TOML file: {error}") from error
    family = _get(path, tables, "case", "name", str)
    cases = {family: tables}
    for axis in tables.pop("variants", {}).values():
        longer = {}
        for name, so_far in cases.items():
            for variant in axis:
                merged = _merged(so_far, {k: v for k, v in variant.items() if k != "name"})
                longer[f"{name}-{variant['name']}"] = merged
        cases = longer
    return cases


def find_case(folder, name):
    """The file in a folder of cases that holds the case of this name, or None."""
    for path in sorted(folder.glob("*.toml")):
        if name.startswith(path.stem) and name in read_tables(path):
            return path
    return None


def read_case(path, name=None):
    """Read and check a case of a case file.

    path: str or Path of a TOML file. name: of the case; needed where the file has variants.
    Returns a Case. Raises InputError naming file, key, value, rule and what is allowed.
    """
    cases = read_tables(path)
    if name is None and len(cases) > 1:
        raise InputError(f"{path}: has variants: one of {', '.join(cases)} is required")
    name = name or next(iter(cases))
    if name not in cases:
        raise InputError(f"{path}: no case {name!r}; {_allowed(name, cases)}")
    tables = cases[name]
    law = _get(path, tables, "material", "law", str)
    if law not in LAWS:
        raise InputError(f"{path}: material.law = {law!r}: unknown law; {_allowed(law, LAWS)}")
    _check_keys(path, "material", tables["material"], ("law", "density", *parameters(law)))
    material = {
        key: _material_number(path, tables, key)
        for key, required in parameters(law).items()
        if required or key in tables["material"]
    }
    entries = tables.get("displacement", [])
    rotations = tables.get("rotation", [])
    if not isinstance(entries, list) or not (entries or rotations):
        raise InputError(
            f"{path}: no [[displacement]] or [[rotation]]: at least one table is required"
        )
    return Case(
        name=name,
        law=law,
        material=material,
        displacements=tuple(_displacement(path, i, entry) for i, entry in enumerate(entries)),
        forces=tuple(_force(path, i, entry) for i, entry in enumerate(tables.get("force", []))),
        rotations=tuple(_rotation(path, i, entry) for i, entry in enumerate(rotations)),
    )


def _material_number(path, tables, key):
    """material.key: a finite number or a tuple of three; other rules are the solver's."""
    value = tables["material"].get(key)
    if isinstance(value, list):
        if len(value) == 3 and all(_is_number(v) and math.isfinite(v) for v in value):
            return tuple(float(v) for v in value)
        raise InputError(f"{path}: material.{key} = {value!r}: must be three finite numbers")
    value = _get(path, tables, "material", key, float)
    if key == "poisson_ratio" and not -1 < value < 0.5:
        raise InputError(f"{path}: material.{key} = {value}: must lie in (-1, 0.5)")
    if key in ("young_modulus", "bulk_modulus") and not value > 0:
        raise InputError(f"{path}: material.{key} = {value}: must be positive (Pa)")
    if not math.isfinite(value):
        raise InputError(f"{path}: material.{key} = {value}: must be finite")
    return value


def _merged(tables, changes):
    """Tables with changes added or put in place; tables within are merged, lists replaced."""
    merged = dict(tables)
    for key, value in changes.items():
        both = isinstance(value, dict) and isinstance(tables.get(key), dict)
        merged[key] = _merged(tables[key], value) if both else value
    return merged


def _force(path, index, entry):
    """One checked [[force]] table as a Force."""
    where = f"force[{index}]"
    _check_keys(path, where, entry, ("set", "total", "moment"))
    none = [0.0, 0.0, 0.0]
    vectors = [_vector(path, where, key, entry.get(key, none)) for key in ("total", "moment")]
    return Force(_set_name(path, where, entry), *vectors)


def _rotation(path, index, entry):
    """One checked [[rotation]] table as a Rotation; the file has degrees."""
    where = f"rotation[{index}]"
    _check_keys(path, where, entry, ("set", "axis", "angle", "center", "displacement"))
    axis = entry.get("axis")
    if isinstance(axis, str):
        if axis not in ("x", "y", "z"):
            raise InputError(f"{path}: {where}.axis = {axis!r}: {_allowed(axis, ('x', 'y', 'z'))}")
        axis = [float(axis == letter) for letter in "xyz"]
    axis = _vector(path, where, "axis", axis)
    length = math.hypot(*axis)
    if not length:
        raise InputError(f"{path}: {where}.axis = {list(axis)}: must not be zero")
    angle = entry.get("angle")
    if not (_is_number(angle) and math.isfinite(angle)):
        raise InputError(f"{path}: {where}.angle = {angle!r}: must be a finite number (degrees)")
    center = entry.get("center")
    return Rotation(
        _set_name(path, where, entry),
        tuple(a / length for a in axis),
        angle / 180 * math.pi,
        None if center is None else _vector(path, where, "center", center),
        _vector(path, where, "displacement", entry.get("displacement", [0.0, 0.0, 0.0])),
    )


def _set_name(path, where, entry):
    """The checked set of a table of something imposed."""
    if not isinstance(entry.get("set"), str):
        raise InputError(f"{path}: {where}.set = {entry.get('set')!r}: must be a node set's name")
    return entry["set"]


def _vector(path, where, key, value):
    """Three finite numbers as a tuple."""
    numbers = isinstance(value, list) and all(_is_number(v) for v in value)
    if not (numbers and len(value) == 3 and all(math.isfinite(v) for v in value)):
        raise InputError(f"{path}: {where}.{key} = {value!r}: must be three finite numbers")
    return tuple(float(v) for v in value)


def _displacement(path, index, entry):
    """One checked [[displacement]] table as a Displacement."""
    where = f"displacement[{index}]"
    _check_keys(path, where, entry, ("set", "value", "components"))
    set_name = entry.get("set")
    if not isinstance(set_name, str):
        raise InputError(f"{path}: {where}.set = {set_name!r}: must be the name of a node set")
    value = entry.get("value")
    numbers = isinstance(value, list) and all(_is_number(v) for v in value)
    if not (numbers and len(value) == 3 and all(math.isfinite(v) for v in value)):
        raise InputError(f"{path}: {where}.value = {value!r}: must be three finite numbers (m)")
    components = entry.get("components", "xyz")
    letters = components if isinstance(components, str) else ""
    if not letters or len(set(letters)) != len(letters) or not set(letters) <= set("xyz"):
        raise InputError(
            f"{path}: {where}.components = {components!r}: must be letters out of 'xyz', each "
            "at most once, at least one"
        )
    axes = tuple(sorted("xyz".index(letter) for letter in letters))
    return Displacement(set_name, tuple(float(v) for v in value), axes)


def _get(path, tables, table, key, kind):
    """The value of table.key, checked to be a string or a number."""
    if not isinstance(tables.get(table), dict):
        raise InputError(f"{path}: table [{table}] is missing")
    value = tables[table].get(key)
    if kind is float and _is_number(value):
        return float(value)
    if kind is str and isinstance(value, str):
        return value
    wanted = {str: "a string", float: "a number"}[kind]
    found = "is missing" if value is None else f"= {value!r}"
    raise InputError(f"{path}: {table}.{key} {found}: {wanted} is required")


def _is_number(value):
    """True for a TOML integer or float (booleans are integers in Python, not here)."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _check_keys(path, where, table, known):
    """Raise InputError at the first key of the table that is not known."""
    for key in table:
        if key not in known:
            raise InputError(f"{path}: {where}.{key}: unknown key; {_allowed(key, known)}")


def _allowed(word, known):
    """The allowed words, and the nearest one when there is one."""
    nearest = difflib.get_close_matches(word, known, n=1)
    hint = f"did you mean {nearest[0]!r}? " if nearest else ""
    return f"{hint}allowed: {', '.join(sorted(known))}"
