"""Sandglass's own HDF5 files: mesh, displacement, and the data of a deck."""

import math
from dataclasses import fields

import h5py
import numpy as np

from common.errors import InputError
from common.result_file import text_of
from exchange.decks.contact import Obstacle, Pair
from exchange.decks.problem import Material, Motion, Problem, agreed
from exchange.foreign_mesh import HexMesh


def read_mesh(path):
    """The HexMesh of a file written by `sandglass`, unchecked."""
    with h5py.File(path, "r") as file:
        mesh = file["mesh"]
        sets = {name: nodes[...] for name, nodes in mesh.get("sets", {}).items()}
        element_sets = {name: some[...] for name, some in mesh.get("element_sets", {}).items()}
        return HexMesh(mesh["points"][...], mesh["cells"][...], sets, element_sets)


def write_mesh(path, mesh):
    """Writes a HexMesh in the form that `sandglass` reads."""
    with h5py.File(path, "w") as file:
        file["mesh/points"] = mesh.points
        file["mesh/cells"] = mesh.cells.astype(np.int64)
        for name, nodes in mesh.sets.items():
            file[f"mesh/sets/{name}"] = nodes.astype(np.int64)
        for name, elements in mesh.element_sets.items():
            file[f"mesh/element_sets/{name}"] = elements.astype(np.int64)


def read_problem(path):
    """The Problem of a file written by suite/commands/deck_file.cpp."""
    mesh = read_mesh(path)
    with h5py.File(path, "r") as file:
        attributes = {k: text_of(v) for k, v in file.attrs.items()}
        imposed = file["problem/imposed"][...] if "problem/imposed" in file else np.empty((0, 3))
        loads = file["problem/forces"][...] if "problem/forces" in file else np.empty((0, 4))
        made_of = file["mesh/materials"][...] if "mesh/materials" in file else None
        ties = file["problem/ties"][...] if "problem/ties" in file else np.empty((0, 3))
        obstacles, pairs = (
            [kind(**_keys(kind, group[i])) for i in sorted(group, key=int)]
            for kind, group in (
                (Obstacle, file.get("problem/obstacles", {})),
                (Pair, file.get("problem/contacts", {})),
            )
        )
    shape = mesh.points.shape
    prescribed, values, forces = np.zeros(shape, dtype=bool), np.zeros(shape), np.zeros(shape)
    at = imposed[:, 0].astype(int), imposed[:, 1].astype(int)
    prescribed[at], values[at] = True, imposed[:, 2]
    np.add.at(forces, loads[:, 0].astype(int), loads[:, 1:])
    followed = {}
    for node, other, weight in ties.tolist():
        followed.setdefault(int(node), []).append((int(other), weight))
    if made_of is None:
        made_of = np.zeros(len(mesh.cells), dtype=int)
    materials = [
        _material(attributes, f"material.{i}.", np.flatnonzero(made_of == i))
        for i in range(made_of.max() + 1)
    ]
    return Problem(
        title=f"{attributes['case']}, mesh {attributes['mesh_hash']}",
        mesh=mesh,
        materials=materials,
        prescribed=prescribed,
        values=values,
        forces=forces,
        motion=_motion(attributes) if "duration" in attributes else None,
        stable_step=float(attributes["stable_step"]),
        obstacles=obstacles,
        pairs=pairs,
        ties=followed,
    )


def _keys(kind, group):
    """The fields of an Obstacle or a Pair that a group has, as attributes or datasets."""
    found = {key: text_of(value) for key, value in group.attrs.items()}
    found = {key: v if isinstance(v, str) else agreed(v) for key, v in found.items()}
    found |= {key: data[...] for key, data in group.items()}
    return {one.name: found[one.name] for one in fields(kind) if one.name in found}


def _material(attributes, prefix, elements):
    """The Material whose attributes have this prefix."""
    own = {k.removeprefix(prefix): v for k, v in attributes.items() if k.startswith(prefix)}
    word = "parameter."
    parameters = {k.removeprefix(word): float(v) for k, v in own.items() if k.startswith(word)}
    numbers = [float(own[key]) for key in ("density", "shear_modulus", "bulk_modulus")]
    return Material(own["law"], parameters, *numbers, own["volumetric"], elements)


def _motion(attributes):
    """The Motion of a dynamic case; its steps are shortened so that they fill the ramp."""
    ramp, duration = attributes["ramp_time"], attributes["duration"]
    ramp_steps = max(1, math.ceil(ramp / attributes["time_step"] - 1e-6))
    step = ramp / ramp_steps
    return Motion(float(step), round(duration / step), ramp_steps, float(attributes["damping"]))


def read_displacement(path, warn):
    """(points (n, 3) or None, displacement (n, 3)), m: the last frame of a result of `sandglass
    run`, or the dataset displacement with points, mesh/points or neither. Raises InputError.
    """
    try:
        with h5py.File(path, "r") as file:
            frames = sorted(file["frames"]) if "frames" in file else []
            name = f"frames/{frames[-1]}/displacement" if frames else "displacement"
            at = next((n for n in ("points", "mesh/points") if n in file), None)
            if name not in file:
                raise InputError(
                    f"{path}: dataset 'displacement' (n, 3) is required, or the frames of a result"
                )
            status = text_of(file.attrs.get("status", "complete"))
            if status != "complete":
                warn(f"incomplete result: its run ended with status '{status}'")
            found = [_nodal(path, file, at) if at else None, _nodal(path, file, name)]
    except InputError:
        raise
    except Exception as error:  # a library may fail in any way on a damaged file
        raise InputError(f"{path}: cannot be read as HDF5: {error}") from error
    if found[0] is not None and len(found[0]) != len(found[1]):
        raise InputError(
            f"{path}: {at} has {len(found[0])} rows, {name} {len(found[1])}; both need equally many"
        )
    return tuple(found)


def write_displacement(path, displacement):
    """Writes displacements (n, 3) in the form that `sandglass score` reads."""
    with h5py.File(path, "w") as file:
        file["displacement"] = displacement


def _nodal(path, file, name):
    """A dataset (n, 3) of numbers. Raises InputError."""
    data = file[name]
    if data.ndim != 2 or data.shape[1] != 3 or data.dtype.kind not in "fiu":
        raise InputError(f"{path}: {name} has shape {data.shape}, {data.dtype}; (n, 3) is required")
    return data[...].astype(float)
