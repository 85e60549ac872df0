"""Generates (with `sandglass mesh CASE -o FILE`) and reads mesh files."""

import dataclasses
import tempfile
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from case_file import read_case
from common.errors import InputError, suggestion
from common.program import ROOT, binary, output_of
from common.result_file import text_of
from common.hexahedron import boundary_faces
from hexahedra import Attached, Condition, HexMesh, Surface, Touching, traction, turn_about


TIES = ("node", "of", "weight")  # datasets of hanging nodes


@dataclass(frozen=True)
class MeshFile:
    """A mesh file's contents: points (n, 3) m, cells (m, 8) VTK, sets, origin.

    materials: (m,) the number of each element's material; None without several. axes: (m, 3, 3)
    material axes of each element by rows; None without fibres. ties: as of HexMesh.
    """

    points: np.ndarray
    cells: np.ndarray
    sets: dict
    case: str
    case_hash: str
    mesh_hash: str
    materials: np.ndarray | None = None
    axes: np.ndarray | None = None
    ties: tuple | None = None


def make_mesh(case_path, output, name=None):
    """Runs `sandglass mesh CASE -o OUTPUT`.

    case_path: str or Path of a case file. name: the case's name, if the file has variants. Raises
    InputError or ComputationError if the program is missing or fails.
    """
    case_path = Path(case_path).resolve()
    case = case_path.parent / name if name else case_path
    output_of(binary(), "mesh", case, "-o", Path(output).resolve(), cwd=ROOT)


def case_with_mesh(path, name=None):
    """(Case, HexMesh, MeshFile) of a case, whose mesh the program makes; arguments of make_mesh().

    Raises InputError or ComputationError.
    """
    with tempfile.TemporaryDirectory() as folder:
        make_mesh(path, Path(folder) / "mesh.h5", name)
        case = read_case(path, name)
        return case, *load_case_mesh(case, Path(folder) / "mesh.h5")


def read_mesh(path):
    """Reads a mesh file. path: str or Path of what `sandglass mesh` wrote, which has checked it.

    Returns a MeshFile. Raises InputError naming the file, and the dataset or attribute it lacks.
    """
    try:
        with h5py.File(path, "r") as file:
            mesh = file["mesh"]
            origin = {
                name: str(text_of(file.attrs[name])) for name in ("case", "case_hash", "mesh_hash")
            }
            ties = [mesh[f"ties/{name}"][...] for name in TIES] if "ties" in mesh else None
            return MeshFile(
                mesh["points"][...],
                mesh["cells"][...],
                {name: nodes[...] for name, nodes in mesh.get("sets", {}).items()},
                materials=mesh["materials"][...] if "materials" in mesh else None,
                axes=mesh["axes"][...] if "axes" in mesh else None,
                ties=ties and tuple(ties),
                **origin,
            )
    except OSError as error:
        raise InputError(f"{path}: cannot be read as HDF5: {error}") from error
    except KeyError as error:
        raise InputError(f"{path}: is not of `sandglass mesh`: {error.args[0]}") from error


def load_case_mesh(case, mesh_path):
    """The mesh of a case, with the displacements and tractions of the case.

    case: Case. mesh_path: str or Path. Returns (HexMesh, MeshFile).
    Raises InputError if the mesh belongs to another case, a set is missing or empty, two
    displacements contradict each other, a force has no face, or nothing is imposed.
    """
    file = read_mesh(mesh_path)
    if file.case != case.name:
        raise InputError(
            f"{mesh_path}: attribute case = {file.case!r} must be {case.name!r}: the mesh belongs "
            f"to another case (sandglass mesh {case.name} -o FILE)"
        )
    if len(case.materials) > 1 and (
        file.materials is None or file.materials.max() >= len(case.materials)
    ):
        raise InputError(
            f"{mesh_path}: /mesh/materials must have a number below {len(case.materials)} for each "
            "element, as the case has this many materials"
        )
    mesh = HexMesh(
        file.points, file.cells, (), materials=file.materials, axes=file.axes, ties=file.ties
    )
    for entry in case.displacements:
        nodes = _mask(file, _members(mesh_path, file, "displacement", entry.set_name))
        condition = Condition(nodes, entry.components, np.tile(entry.value, (len(nodes), 1)))
        mesh = _with_condition(mesh_path, mesh, condition, f"displacement.set = {entry.set_name!r}")
    for entry in case.rotations:
        members = _members(mesh_path, file, "rotation", entry.set_name)
        center = file.points[members].mean(axis=0) if entry.center is None else entry.center
        turn = turn_about(file.points, np.array(entry.axis), center, entry.angle)
        values = np.tile(entry.displacement, (len(file.points), 1))
        condition = Condition(_mask(file, members), (0, 1, 2), values, turn)
        mesh = _with_condition(mesh_path, mesh, condition, f"rotation.set = {entry.set_name!r}")
    tractions = []
    for entry in case.forces:
        nodes = _mask(file, _members(mesh_path, file, "force", entry.set_name))
        pull = traction(file.points, file.cells, nodes, entry.total, entry.moment)
        if pull is None:
            raise InputError(
                f"{mesh_path}: force.set = {entry.set_name!r}: no boundary face has all its "
                "vertices in this set; a force needs at least one"
            )
        tractions.append(dataclasses.replace(pull, curve=entry.curve))
    surfaces = tuple(
        Surface(_loaded(mesh_path, file, "pressure", one.set_name), one.value, curve=one.curve)
        for one in case.pressures
    ) + tuple(
        Surface(
            _loaded(mesh_path, file, "support", one.set_name),
            stiffness=one.stiffness,
            only_normal=one.only_normal,
        )
        for one in case.supports
    )
    touching = tuple(
        Touching(_loaded(mesh_path, file, "obstacle", one.set_name), one) for one in case.obstacles
    )
    contacts = tuple(
        tuple(_loaded(mesh_path, file, "contact", name) for name in (one.set_name, one.other_name))
        for one in case.contacts
    )
    pushed = tractions or case.pressures or touching or case.gravity
    if not (mesh.largest_imposed() or pushed or case.motion and case.motion.velocities):
        raise InputError(f"{mesh_path}: case {case.name!r} moves no node: nothing to solve")
    loads = {"tractions": tuple(tractions), "surfaces": surfaces, "gravity": case.gravity}
    masses = tuple(
        Attached(_mask(file, _members(mesh_path, file, "mass", one.set_name)), one.total)
        for one in case.masses
    )
    return (
        dataclasses.replace(mesh, **loads, touching=touching, masses=masses, contacts=contacts),
        file,
    )


def initial_velocity(case, mesh_path):
    """The velocity (n, 3) in m/s of all nodes at the start of a dynamic Case.

    mesh_path: of its mesh file. Raises InputError if a set is missing or has no extent.
    """
    file = read_mesh(mesh_path)
    total = np.zeros_like(file.points)
    for start in case.motion.velocities:
        nodes = np.arange(len(file.points))
        if start.set_name is not None:
            nodes = _members(mesh_path, file, "velocity", start.set_name)
        x = file.points[nodes]
        wave = np.ones(len(nodes))
        for axis, half_waves in enumerate(start.half_waves):
            low, extent = x[:, axis].min(), np.ptp(x[:, axis])
            if half_waves and not extent:
                raise InputError(f"{mesh_path}: velocity: no extent along {'xyz'[axis]} for a wave")
            if half_waves:
                wave *= np.cos(np.pi * half_waves * (x[:, axis] - low) / extent)
        total[nodes] += wave[:, None] * start.value
    return total


def _loaded(mesh_path, file, table, set_name):
    """(n,) bool of the nodes of a set. Raises InputError if it has no boundary face."""
    nodes = _mask(file, _members(mesh_path, file, table, set_name))
    if not nodes[boundary_faces(file.cells)].all(axis=1).any():
        raise InputError(
            f"{mesh_path}: {table}.set = {set_name!r}: no boundary face has all its vertices in "
            "this set; at least one is needed"
        )
    return nodes


def _with_condition(mesh_path, mesh, condition, where):
    """The HexMesh with one more Condition. Raises InputError if it contradicts the others."""
    for load in (1.0, 0.3):  # paths of rotations may agree at one load and differ at another
        prescribed, values = mesh.imposed(load)
        for axis in condition.components:
            already = np.flatnonzero(prescribed[:, axis] & condition.nodes)
            if (values[already, axis] != condition.at(load)[already, axis]).any():
                raise InputError(
                    f"{mesh_path}: {where}: component {'xyz'[axis]} of node {already[0]} is "
                    "already prescribed with another value"
                )
    return dataclasses.replace(mesh, conditions=mesh.conditions + (condition,))


def _members(mesh_path, file, table, set_name):
    """The nodes of a set of a MeshFile. Raises InputError if there are none."""
    members = file.sets.get(set_name, np.empty(0, dtype=np.int64))
    if not members.size:
        known = sorted(n for n, s in file.sets.items() if s.size)
        raise InputError(
            f"{mesh_path}: {table}.set = {set_name!r} is not a non-empty node set; "
            + suggestion(set_name, known)
        )
    return members


def _mask(file, members):
    """(n,) bool, True for the members among the nodes of a MeshFile."""
    nodes = np.zeros(len(file.points), dtype=bool)
    nodes[members] = True
    return nodes
