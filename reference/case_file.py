"""Reads the parts of a case file (TOML) that the reference needs: material, loads, motion."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from common.case_tables import read_tables
from common.errors import InputError, suggestion
from common.records import NUMBER, entries, entry
from laws import LAWS, VOLUMES, parameters
from load_curve import CURVE, factor_and_curve
from obstacles import SHAPES, Obstacle, shape_keys


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
class Gravity:
    """An acceleration (3,) in m/s^2 of all masses. curve: as of a Force."""

    value: tuple
    curve: Callable | None = None


@dataclass(frozen=True)
class PointMass:
    """A mass (kg) attached to a node set, in equal shares."""

    set_name: str
    total: float


@dataclass(frozen=True)
class Support:
    """Springs on faces within a node set: stiffness in Pa/m, in all or only normal directions."""

    set_name: str
    stiffness: float
    only_normal: bool


@dataclass(frozen=True)
class Contact:
    """Two node sets whose faces may touch each other, without friction."""

    set_name: str
    other_name: str


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

    motion: a Motion, or None for a quasi-static case. obstacles: tuple of Obstacle, which nothing
    penetrates. contacts: tuple of Contact.
    """

    name: str
    materials: tuple
    displacements: tuple
    forces: tuple = ()
    rotations: tuple = ()
    pressures: tuple = ()
    supports: tuple = ()
    gravity: tuple = ()
    masses: tuple = ()
    motion: Motion | None = None
    obstacles: tuple = ()
    contacts: tuple = ()


def find_case(folder, name):
    """The file in a folder of cases that defines the case of this name, or None."""
    for path in sorted(folder.glob("*.toml")):
        if name.startswith(path.stem) and name in read_tables(path):
            return path
    return None


def read_case(path, name=None):
    """Read a case from a case file.

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
    obstacles = read_all("obstacle", _obstacle, moving)
    if not (displacements or rotations or supports or obstacles or moving):
        tables = "[[displacement]], [[rotation]], [[support]] or [[obstacle]]"
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
        gravity=read_all("gravity", _gravity, moving),
        masses=read_all("mass", _mass),
        motion=_motion(path, tables, read_all("velocity", _velocity)) if moving else None,
        obstacles=obstacles,
        contacts=read_all("contact", _contact, moving),
    )


def _motion(path, tables, velocities):
    """The Motion of a dynamic case. Raises InputError for features without a golden of motion."""
    for where, table in entries(path, tables, "support") if "support" in tables else ():
        if "damping" in table:
            raise InputError(f"{where}: damping: not supported by goldens of motion")
    table = entry(path, tables, "dynamics", dict)
    keys = {"duration": float, "ramp_time": 0.0, "damping": 0.0, "frames": 20}
    found = _read(f"{path}: dynamics", table, *table, **keys)
    found["ramp_time"] = found["ramp_time"] or found["duration"]
    return Motion(**found, velocities=velocities)


def _velocity(where, table):
    """A [[velocity]] table as an InitialVelocity."""
    return InitialVelocity(
        *_read(where, table, set=None, value=tuple, half_waves=(0.0, 0.0, 0.0)).values()
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
    """A [material] table, or one of [[materials]], as a Material."""
    law = entry(where, table, "law", str)
    if law not in LAWS:
        raise InputError(f"{where}.law = {law!r} is not known; {suggestion(law, LAWS)}")
    numbers = {
        key: tuple if isinstance(table.get(key), list) else float
        for key, required in parameters(law).items()
        if required or key in table
    }
    found = _read(
        where,
        table,
        *KEYS_OF_ANY_LAW,
        *parameters(law),
        density=0.0,
        volumetric="quadratic",
        **numbers,
    )
    density, volumetric = found.pop("density"), found.pop("volumetric")
    if volumetric not in VOLUMES:
        known = suggestion(volumetric, VOLUMES)
        raise InputError(f"{where}.volumetric = {volumetric!r} is not known; {known}")
    return Material(law, found, density, volumetric)


def _displacement(where, table):
    """A [[displacement]] table as a Displacement. where: file, key and index of it."""
    found = _read(where, table, set=str, value=tuple, components="xyz")
    letters = found["components"]
    if not letters or not set(letters) <= set("xyz"):
        raise InputError(f"{where}.components = {letters!r} must be letters of 'xyz'")
    return Displacement(found["set"], found["value"], tuple(sorted(map("xyz".index, letters))))


def _rotation(where, table):
    """A [[rotation]] table as a Rotation; the file has degrees."""
    by_letter = isinstance(table.get("axis"), str) and table["axis"] in tuple("xyz")
    keys = {"center": None, "displacement": (0.0, 0.0, 0.0)}
    found = _read(where, table, set=str, axis=str if by_letter else tuple, angle=float, **keys)
    axis = found["axis"]
    if by_letter:
        axis = tuple(float(axis == letter) for letter in "xyz")
    length = math.hypot(*axis)
    if not length:
        raise InputError(f"{where}.axis = {list(axis)} must not be zero")
    found["axis"], found["angle"] = tuple(a / length for a in axis), math.radians(found["angle"])
    return Rotation(*found.values())


def _force(where, table, moving):
    """A [[force]] table as a Force."""
    zero = (0.0, 0.0, 0.0)
    found = _read(where, table, *CURVE, set=str, total=zero, moment=zero, on="faces")
    if found["on"] != "faces":
        rule = "must be 'faces': the reference supports no other"
        raise InputError(f"{where}.on = {found['on']!r} {rule}")
    factor, curve = factor_and_curve(where, table, moving)
    loads = (tuple(factor * v for v in found[key]) for key in ("total", "moment"))
    return Force(found["set"], *loads, curve)


def _pressure(where, table, moving):
    """A [[pressure]] table as a Pressure."""
    found = _read(where, table, *CURVE, set=str, value=float)
    factor, curve = factor_and_curve(where, table, moving)
    return Pressure(found["set"], factor * found["value"], curve)


def _gravity(where, table, moving):
    """A [[gravity]] table as a Gravity."""
    factor, curve = factor_and_curve(where, table, moving)
    value = _read(where, table, *CURVE, value=tuple)["value"]
    return Gravity(tuple(factor * v for v in value), curve)


def _mass(where, table):
    """A [[mass]] table as a PointMass."""
    return PointMass(*_read(where, table, set=str, total=float).values())


def _support(where, table):
    """A [[support]] table as a Support; its damping has no effect in statics."""
    return Support(
        *_read(where, table, "damping", set=str, stiffness=0.0, only_normal=False).values()
    )


def _obstacle(where, table, moving):
    """An [[obstacle]] table as an Obstacle."""
    if moving or table.get("friction"):
        raise InputError(f"{where}: contact in motion or with friction is not supported here")
    shape = entry(where, table, "shape", str)
    if shape not in SHAPES:
        raise InputError(f"{where}.shape = {shape!r} is not known; {suggestion(shape, SHAPES)}")
    own = {key: float if key == "radius" else tuple for key in shape_keys(shape)}
    others = (*CURVE, "name", "shape", "method", "friction", "move", *own)
    keys = {"displacement": (0.0, 0.0, 0.0), "inside": False, "penalty": Obstacle.penalty}
    name, moved, *rest = _read(where, table, *others, set=str, **keys).values()
    legs = [(where, table, moved)]
    for place, move in entries(where, table, "move") if "move" in table else ():
        legs.append((place, move, _read(place, move, *CURVE, displacement=tuple)["displacement"]))
    moved = sum(factor_and_curve(*leg, moving)[0] * np.array(way) for *leg, way in legs)
    own = _read(where, table, *table, **own)
    return Obstacle(name, shape, own, tuple(moved.tolist()), *rest)


def _contact(where, table, moving):
    """A [[contact]] table as a Contact."""
    if moving or table.get("friction"):
        raise InputError(f"{where}: contact in motion or with friction is not supported here")
    others = (*CURVE, "name", "penalty", "method", "friction")
    return Contact(*_read(where, table, *others, set=str, other=str).values())


def _read(where, table, *others, **keys):
    """The values of a table's keys, in their order: vectors as tuples, numbers as floats.

    keys: a type (float: any number; tuple: a vector) of a required key, or the default of an
    optional one; None: a vector or a text. others: keys that are read elsewhere. Raises InputError
    for any other key: ignoring it would solve a different case. The rules for values are those of
    `sandglass mesh`, which has read the same file.
    """
    found = {}
    for key in table:
        if key not in keys and key not in others:
            raise InputError(f"{where}.{key}: unknown key; {suggestion(key, (*keys, *others))}")
    for key, given in keys.items():
        kind = given if isinstance(given, type) else type(given)
        if given is None and key in table:
            kind = tuple if isinstance(table[key], list) else str
        if not isinstance(given, type) and key not in table:
            found[key] = given
        elif kind is tuple:
            found[key] = _vector(where, table, key)
        elif kind is float:
            found[key] = float(entry(where, table, key, NUMBER))
        else:
            found[key] = entry(where, table, key, kind)
    return found


def _vector(where, table, key):
    """Three finite numbers of a table as a tuple."""
    value = entry(where, table, key, list)
    numbers = [v for v in value if isinstance(v, NUMBER) and not isinstance(v, bool)]
    if not (len(value) == len(numbers) == 3 and all(map(math.isfinite, numbers))):
        raise InputError(f"{where}.{key} = {value!r} must be three finite numbers")
    return tuple(map(float, numbers))
