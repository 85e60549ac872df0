"""Reads the parts of a case file (TOML) that the reference needs: material and displacements."""

import math
from dataclasses import dataclass

import numpy as np

from common.errors import InputError, suggestion
from common.files import read_toml
from common.records import NUMBER, entries, entry
from laws import LAWS, VOLUMES, parameters


KEYS_OF_ANY_LAW = ("law", "density", "elements", "volumetric") + (
    "fibre_direction",  # the solver checks these and writes the axes that follow from them
    "sheet_direction",
    "fibres",
)


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
    in m, in addition to the rotation.
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
class Pressure:
    """A pressure (Pa) that pushes on the faces within a node set and follows them."""

    set_name: str
    value: float


@dataclass(frozen=True)
class Support:
    """Springs on the faces within a node set: stiffness in Pa/m, along the normal alone or not."""

    set_name: str
    stiffness: float
    only_normal: bool


@dataclass(frozen=True)
class Material:
    """A material: a name in LAWS, the law's parameters (SI units), directions as tuples.

    density: kg/m^3. volumetric: a name in VOLUMES. Its fibres are in the mesh file, as axes.
    """

    law: str
    parameters: dict
    density: float = 0.0
    volumetric: str = "quadratic"


@dataclass(frozen=True)
class Case:
    """A case: name, materials in the order of the file, imposed motions and loads.

    gravity: (3,) m/s^2.
    """

    name: str
    materials: tuple
    displacements: tuple
    forces: tuple = ()
    rotations: tuple = ()
    pressures: tuple = ()
    supports: tuple = ()
    gravity: tuple = (0.0, 0.0, 0.0)


def read_tables(path):
    """The tables of every case in a file, with variants merged in: case name -> dict.

    path: str or Path of a TOML file. A file without [variants] has one case. Raises InputError.
    """
    tables = read_toml(path)
    family = entry(f"{path}: case", entry(path, tables, "case", dict), "name", str)
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
    """The file in a folder of cases that defines the case of this name, or None."""
    for path in sorted(folder.glob("*.toml")):
        if name.startswith(path.stem) and name in read_tables(path):
            return path
    return None


def read_case(path, name=None):
    """Read and check a case from a case file.

    path: str or Path of a TOML file. name: the case's name; required if the file has variants.
    Returns a Case. Raises InputError naming file, key, value, rule and what is allowed.
    """
    name, tables = _chosen(path, read_tables(path), name)

    def read_all(key, read):
        return tuple(read(*one) for one in (entries(path, tables, key) if key in tables else ()))

    displacements, rotations = read_all("displacement", _displacement), read_all(
        "rotation", _rotation
    )
    supports = read_all("support", _support)
    if not (displacements or rotations or supports):
        raise InputError(
            f"{path}: has no [[displacement]], [[rotation]] or [[support]]; at least one table is "
            "required"
        )
    if "materials" in tables:
        materials = read_all("materials", _material)
    else:
        materials = (_material(f"{path}: material", entry(path, tables, "material", dict)),)
    return Case(
        name=name,
        materials=materials,
        displacements=displacements,
        forces=read_all("force", _force),
        rotations=rotations,
        pressures=read_all("pressure", _pressure),
        supports=supports,
        gravity=tuple(map(sum, zip((0.0, 0.0, 0.0), *read_all("gravity", _gravity)))),
    )


def _chosen(path, cases, name):
    """(name, tables) of the named case among those of a file; without a name the only one."""
    if name is None and len(cases) > 1:
        raise InputError(
            f"{path}: has {len(cases)} variants; name one of them; known: {', '.join(cases)}"
        )
    name = name or next(iter(cases))
    if name not in cases:
        raise InputError(f"{path}: has no case {name!r}; {suggestion(name, cases)}")
    return name, cases[name]


def _material(where, table):
    """A checked [material] table, or one of [[materials]], as a Material."""
    law = entry(where, table, "law", str)
    if law not in LAWS:
        raise InputError(f"{where}.law = {law!r} is not known; {suggestion(law, LAWS)}")
    _check_keys(where, table, (*KEYS_OF_ANY_LAW, *parameters(law)))
    numbers = {
        key: _material_number(where, table, key)
        for key, required in parameters(law).items()
        if required or key in table
    }
    density = entry(where, table, "density", NUMBER) if "density" in table else 0.0
    volumetric = entry(where, table, "volumetric", str) if "volumetric" in table else "quadratic"
    if volumetric not in VOLUMES:
        raise InputError(
            f"{where}.volumetric = {volumetric!r} is not known; {suggestion(volumetric, VOLUMES)}"
        )
    return Material(law, numbers, float(density), volumetric)


def _material_number(where, table, key):
    """A finite number or a tuple of three; the solver checks all other rules."""
    if isinstance(table.get(key), list):
        return _vector(where, table, key)
    value = float(entry(where, table, key, NUMBER))
    if key == "poisson_ratio" and not -1 < value < 0.5:
        raise InputError(f"{where}.{key} = {value} must be in (-1, 0.5)")
    if key in ("young_modulus", "bulk_modulus") and not value > 0:
        raise InputError(f"{where}.{key} = {value} must be positive (Pa)")
    return value


def _merged(tables, changes):
    """Tables with changes applied: nested tables are merged, other values replaced."""
    merged = dict(tables)
    for key, value in changes.items():
        both = isinstance(value, dict) and isinstance(tables.get(key), dict)
        merged[key] = _merged(tables[key], value) if both else value
    return merged


def _displacement(where, table):
    """A checked [[displacement]] table as a Displacement. where: file, key and index of it."""
    _check_keys(where, table, ("set", "value", "components"))
    letters = entry(where, table, "components", str) if "components" in table else "xyz"
    if not letters or len(set(letters)) != len(letters) or not set(letters) <= set("xyz"):
        raise InputError(
            f"{where}.components = {letters!r} must be one or more of the letters 'xyz', each at "
            "most once"
        )
    return Displacement(
        entry(where, table, "set", str),
        _vector(where, table, "value"),
        tuple(sorted("xyz".index(letter) for letter in letters)),
    )


def _rotation(where, table):
    """A checked [[rotation]] table as a Rotation; the file has degrees."""
    _check_keys(where, table, ("set", "axis", "angle", "center", "displacement"))
    axis = table.get("axis")
    if isinstance(axis, str):
        if axis not in ("x", "y", "z"):
            raise InputError(f"{where}.axis = {axis!r} must be 'x', 'y', 'z' or a vector")
        axis = [float(axis == letter) for letter in "xyz"]
    else:
        axis = _vector(where, table, "axis")
    length = math.hypot(*axis)
    if not length:
        raise InputError(f"{where}.axis = {list(axis)} must not be zero")
    return Rotation(
        entry(where, table, "set", str),
        tuple(a / length for a in axis),
        entry(where, table, "angle", NUMBER) / 180 * math.pi,
        _vector(where, table, "center") if "center" in table else None,
        _vector(where, table, "displacement") if "displacement" in table else (0.0, 0.0, 0.0),
    )


def _force(where, table):
    """A checked [[force]] table as a Force."""
    _check_keys(where, table, ("set", "total", "moment", "on", "times", "factors"))
    if table.get("on", "faces") != "faces":
        raise InputError(
            f"{where}.on = {table['on']!r} must be 'faces': the reference knows no other"
        )
    factor = _final_factor(where, table)
    total, moment = (
        tuple(factor * v for v in _vector(where, table, key)) if key in table else (0.0, 0.0, 0.0)
        for key in ("total", "moment")
    )
    return Force(entry(where, table, "set", str), total, moment)


def _pressure(where, table):
    """A checked [[pressure]] table as a Pressure."""
    _check_keys(where, table, ("set", "value", "times", "factors"))
    value = _final_factor(where, table) * float(entry(where, table, "value", NUMBER))
    return Pressure(entry(where, table, "set", str), value)


def _gravity(where, table):
    """The acceleration of a checked [[gravity]] table."""
    _check_keys(where, table, ("value", "times", "factors"))
    factor = _final_factor(where, table)
    return tuple(factor * v for v in _vector(where, table, "value"))


def _support(where, table):
    """A checked [[support]] table as a Support; its damping plays no part at rest."""
    _check_keys(where, table, ("set", "stiffness", "damping", "only_normal"))
    stiffness = entry(where, table, "stiffness", NUMBER) if "stiffness" in table else 0.0
    only_normal = entry(where, table, "only_normal", bool) if "only_normal" in table else False
    return Support(entry(where, table, "set", str), float(stiffness), only_normal)


def _final_factor(where, table):
    """The factor of a load at the end of a quasi-static answer, whose time is 1."""
    if "times" not in table and "factors" not in table:
        return 1.0
    times, factors = (entry(where, table, key, list) for key in ("times", "factors"))
    return float(np.interp(1.0, times, factors))


def _vector(where, table, key):
    """Three finite numbers of a table as a tuple."""
    value = entry(where, table, key, list)
    numbers = [v for v in value if isinstance(v, NUMBER) and not isinstance(v, bool)]
    if not (len(value) == len(numbers) == 3 and all(map(math.isfinite, numbers))):
        raise InputError(f"{where}.{key} = {value!r} must be three finite numbers")
    return tuple(map(float, numbers))


def _check_keys(where, table, known):
    """Raises InputError for the first unknown key of a table."""
    for key in table:
        if key not in known:
            raise InputError(f"{where}.{key}: unknown key; {suggestion(key, known)}")
