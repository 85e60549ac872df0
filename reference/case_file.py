"""Reads the parts of a case file (TOML) that the reference needs: material, loads, motion."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from common.errors import InputError, suggestion
from common.files import read_toml
from common.records import NUMBER, entries, entry
from laws import LAWS, VOLUMES, parameters
from load_curve import CURVE, factor_and_curve


# The solver checks the directions of fibres and writes the resulting axes.
FIBRES = ("fibre_direction", "sheet_direction", "fibres")
KEYS_OF_ANY_LAW = ("law", "density", "elements", "volumetric", *FIBRES)


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
    """A dead load on the faces within a node set: total (3,) in N, moment (3,) in N m.

    curve: in motion a function from time (s) to factor, or None if it follows the load factor.
    """

    set_name: str
    total: tuple
    moment: tuple
    curve: Callable | None = None


@dataclass(frozen=True)
class Pressure:
    """A pressure (Pa) that pushes on the faces within a node set and follows them.

    curve: as of a Force.
    """

    set_name: str
    value: float
    curve: Callable | None = None


@dataclass(frozen=True)
class Support:
    """Springs on faces within a node set: stiffness in Pa/m, in all or only normal directions."""

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
class InitialVelocity:
    """An initial velocity: node set (None: all nodes), value (3,) in m/s, half waves (3,).

    With half waves along an axis it is value cos(pi half_waves (x - low) / (high - low)).
    """

    set_name: str | None
    value: tuple
    half_waves: tuple


@dataclass(frozen=True)
class Motion:
    """The motion of a dynamic case: duration and ramp time (s), damping (1/s), frames, velocities.

    frames: number of equal parts of the duration at whose ends displacements are stored.
    """

    duration: float
    ramp_time: float
    damping: float
    frames: int
    velocities: tuple = ()

    def load_factor(self, time):
        """The factor of all loads without a curve at a time in s: the paper's eq. 15."""
        t = min(max(time / self.ramp_time, 0.0), 1.0)
        return t**3 * (10 - 15 * t + 6 * t**2)

    def times(self):
        """The times (frames,) in s at which displacements are stored."""
        return self.duration * np.arange(1, self.frames + 1) / self.frames


@dataclass(frozen=True)
class Case:
    """A case: name, materials in the order of the file, imposed motions and loads.

    gravity: (3,) m/s^2. motion: a Motion, or None for a quasi-static case.
    """

    name: str
    materials: tuple
    displacements: tuple
    forces: tuple = ()
    rotations: tuple = ()
    pressures: tuple = ()
    supports: tuple = ()
    gravity: tuple = (0.0, 0.0, 0.0)
    motion: Motion | None = None


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

    moving = tables["case"].get("answer") == "dynamic"

    def read_all(key, read, *how):
        found = entries(path, tables, key) if key in tables else ()
        return tuple(read(*one, *how) for one in found)

    displacements = read_all("displacement", _displacement)
    rotations, supports = read_all("rotation", _rotation), read_all("support", _support)
    if not (displacements or rotations or supports or moving):
        tables = "[[displacement]], [[rotation]] or [[support]]"
        raise InputError(f"{path}: has no {tables}; at least one table is required")
    if "materials" in tables:
        materials = read_all("materials", _material)
    else:
        materials = (_material(f"{path}: material", entry(path, tables, "material", dict)),)
    return Case(
        name=name,
        materials=materials,
        displacements=displacements,
        forces=read_all("force", _force, moving),
        rotations=rotations,
        pressures=read_all("pressure", _pressure, moving),
        supports=supports,
        gravity=tuple(map(sum, zip((0.0, 0.0, 0.0), *read_all("gravity", _gravity)))),
        motion=_motion(path, tables, read_all("velocity", _velocity)) if moving else None,
    )


def _motion(path, tables, velocities):
    """The Motion of a dynamic case. Raises InputError for features without a golden of motion."""
    for key, names in (("gravity", CURVE), ("support", ("damping",))):
        for where, table in entries(path, tables, key) if key in tables else ():
            if set(names) & set(table):
                raise InputError(
                    f"{where}: {' and '.join(names)}: not supported by goldens of motion"
                )
    where, table = f"{path}: dynamics", entry(path, tables, "dynamics", dict)
    number = {
        key: float(entry(where, table, key, NUMBER)) if key in table else 0.0
        for key in ("duration", "ramp_time", "damping")
    }
    if not number["duration"] > 0:
        raise InputError(f"{where}.duration = {number['duration']} must be positive (s)")
    frames = entry(where, table, "frames", int) if "frames" in table else 20
    number["ramp_time"] = number["ramp_time"] or number["duration"]
    return Motion(**number, frames=frames, velocities=velocities)


def _velocity(where, table):
    """A checked [[velocity]] table as an InitialVelocity."""
    _check_keys(where, table, ("set", "value", "half_waves"))
    return InitialVelocity(
        entry(where, table, "set", str) if "set" in table else None,
        _vector(where, table, "value"),
        _vector_or_zero(where, table, "half_waves"),
    )


def _chosen(path, cases, name):
    """(name, tables) of the named case among those of a file; without a name the only one."""
    if name is None and len(cases) > 1:
        known = f"known: {', '.join(cases)}"
        raise InputError(f"{path}: has {len(cases)} variants; name one of them; {known}")
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
        known = suggestion(volumetric, VOLUMES)
        raise InputError(f"{where}.volumetric = {volumetric!r} is not known; {known}")
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
        rule = "must be one or more of the letters 'xyz', each at most once"
        raise InputError(f"{where}.components = {letters!r} {rule}")
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
        _vector_or_zero(where, table, "displacement"),
    )


def _force(where, table, moving):
    """A checked [[force]] table as a Force."""
    _check_keys(where, table, ("set", "total", "moment", "on", *CURVE))
    if table.get("on", "faces") != "faces":
        rule = "must be 'faces': the reference supports no other"
        raise InputError(f"{where}.on = {table['on']!r} {rule}")
    factor, curve = factor_and_curve(where, table, moving)
    vectors = (_vector_or_zero(where, table, key) for key in ("total", "moment"))
    loads = (tuple(factor * v for v in vector) for vector in vectors)
    return Force(entry(where, table, "set", str), *loads, curve)


def _pressure(where, table, moving):
    """A checked [[pressure]] table as a Pressure."""
    _check_keys(where, table, ("set", "value", *CURVE))
    factor, curve = factor_and_curve(where, table, moving)
    value = factor * float(entry(where, table, "value", NUMBER))
    return Pressure(entry(where, table, "set", str), value, curve)


def _gravity(where, table):
    """The acceleration of a checked [[gravity]] table."""
    _check_keys(where, table, ("value", *CURVE))
    factor, _ = factor_and_curve(where, table, moving=False)
    return tuple(factor * v for v in _vector(where, table, "value"))


def _support(where, table):
    """A checked [[support]] table as a Support; damping does not matter in static equilibrium."""
    _check_keys(where, table, ("set", "stiffness", "damping", "only_normal"))
    stiffness = entry(where, table, "stiffness", NUMBER) if "stiffness" in table else 0.0
    only_normal = entry(where, table, "only_normal", bool) if "only_normal" in table else False
    return Support(entry(where, table, "set", str), float(stiffness), only_normal)


def _vector(where, table, key):
    """Three finite numbers of a table as a tuple."""
    value = entry(where, table, key, list)
    numbers = [v for v in value if isinstance(v, NUMBER) and not isinstance(v, bool)]
    if not (len(value) == len(numbers) == 3 and all(map(math.isfinite, numbers))):
        raise InputError(f"{where}.{key} = {value!r} must be three finite numbers")
    return tuple(map(float, numbers))


def _vector_or_zero(where, table, key):
    """Three numbers of a table; zeros if it has none."""
    return _vector(where, table, key) if key in table else (0.0, 0.0, 0.0)


def _check_keys(where, table, known):
    """Raises InputError for the first unknown key of a table."""
    for key in table:
        if key not in known:
            raise InputError(f"{where}.{key}: unknown key; {suggestion(key, known)}")
