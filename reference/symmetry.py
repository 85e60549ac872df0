"""Reduces a mesh to one half for every mirror plane that it has.

The cost of a truth grows with the power 4/3 (memory) to 2 (time) of its unknowns: two mirror planes
make the cylinder's fourteen times cheaper. The answer found is the one with that symmetry.

Two bodies that touch without friction and are mirror images of each other are one body that touches
the mirror plane: a rigid obstacle, which the reference has.
"""

from dataclasses import dataclass, fields, replace

import numpy as np
import scipy.sparse
from scipy.spatial import cKDTree

from common.errors import InputError
from common.hexahedron import FACES
from hexahedra import Condition, HexMesh, Touching
from obstacles import Obstacle

# Coordinates and values that differ by less than this fraction of the mesh's size count as equal.
TOLERANCE = 1e-9


@dataclass(frozen=True)
class Half:
    """One half of a mesh, and the map from its nodes to those of the whole.

    axis: normal of the mirror plane. mesh: HexMesh of the half. source: (n,) node of the half from
    which each node of the whole takes its displacement. mirrored: (n,) True for mirrored nodes.
    """

    axis: int
    mesh: HexMesh
    source: np.ndarray
    mirrored: np.ndarray

    def expand(self, displacement):
        """Displacement (n, 3) on the whole mesh from the displacement on the half."""
        whole = displacement[self.source]
        whole[self.mirrored, self.axis] *= -1
        return whole


def halve(mesh):
    """Halve a HexMesh at every mirror plane normal to x, y or z through its middle.

    Returns (the smallest HexMesh, list of Half in the order of cutting), for expand(). Raises
    InputError as part_bodies() does.
    """
    mesh, halves = part_bodies(mesh)
    for axis in range(3):
        half = _half(mesh, axis)
        if half is not None:
            halves.append(half)
            mesh = half.mesh
    return mesh, halves


def part_bodies(mesh):
    """One of two bodies that touch each other, on a rigid plane between them, and its Half.

    Returns (HexMesh, list of Half), the mesh itself and no Half if it has no contacts. Raises
    InputError unless there are two bodies and they are mirror images of each other, with opposite
    displacements imposed along the normal of the plane and equal ones along it.
    """
    if not mesh.contacts:
        return mesh, []
    first = mesh.cells[:, :1].repeat(8, axis=1)
    links = scipy.sparse.coo_matrix((np.ones(first.size), (first.ravel(), mesh.cells.ravel())))
    links.resize(len(mesh.points), len(mesh.points))
    count, body = scipy.sparse.csgraph.connected_components(links, directed=False)
    plain = {"points", "cells", "conditions", "materials", "contacts"}
    if (
        count != 2
        or len(mesh.contacts) > 1
        or any(
            getattr(mesh, one.name) not in (None, ())
            for one in fields(mesh)
            if one.name not in plain
        )
    ):
        raise InputError(
            f"{_NO_IMAGES}, here {count} parts, without other loads than displacements"
        )
    for axis in range(3):
        half = _one_body(mesh, axis, body)
        if half is not None:
            return half.mesh, [half]
    raise InputError(f"{_NO_IMAGES} with imposed displacements that are also mirrored")


_NO_IMAGES = "[[contact]]: the reference needs two bodies that are mirror images of each other"


def _one_body(mesh, axis, body):
    """The Half that is the upper body along an axis, or None if the other is not its image.

    body: (n,) 0 or 1, the body of each node.
    """
    size = np.ptp(mesh.points)
    middle = (mesh.points[:, axis].min() + mesh.points[:, axis].max()) / 2
    heights = [mesh.points[body == k, axis] - middle for k in (0, 1)]
    upper = int(heights[1].mean() > heights[0].mean())
    kept, other = np.flatnonzero(body == upper), np.flatnonzero(body != upper)
    if len(kept) != len(other) or heights[upper].min() < -TOLERANCE * size:
        return None
    image_points = mesh.points[other].copy()
    image_points[:, axis] = 2 * middle - image_points[:, axis]
    distance, image = cKDTree(mesh.points[kept]).query(image_points)
    if distance.max() > TOLERANCE * size or len(np.unique(image)) < len(kept):
        return None
    source = np.empty(len(mesh.points), dtype=int)  # the node of the half, for each node
    source[kept], source[other] = np.arange(len(kept)), image
    of_half = body[mesh.cells[:, 0]] == upper
    cells, mirrored_cells = source[mesh.cells[of_half]], source[mesh.cells[~of_half]]
    if not np.array_equal(_as_sets(cells), _as_sets(mirrored_cells)):
        return None
    materials = None if mesh.materials is None else mesh.materials[of_half]
    if materials is not None and (mesh.materials != materials[0]).any():
        return None
    prescribed, values = mesh.imposed()
    opposite = np.where(np.arange(3) == axis, -1.0, 1.0)
    mirrored = np.empty((2, len(kept), 3))
    mirrored[0][image], mirrored[1][image] = prescribed[other], values[other] * opposite
    if any(c.turn for c in mesh.conditions) or not (
        np.array_equal(mirrored[0], prescribed[kept])
        and np.allclose(mirrored[1], values[kept], rtol=0.0, atol=TOLERANCE * size)
    ):
        return None
    touching = mesh.contacts[0][0] | mesh.contacts[0][1]
    normal, point = np.eye(3)[axis], middle * np.eye(3)[axis]
    plane = Obstacle("", "plane", {"point": tuple(point), "normal": tuple(normal)})
    conditions = tuple(
        Condition(c.nodes[kept], c.components, c.values[kept])
        for c in mesh.conditions
        if c.nodes[kept].any()
    )
    half = HexMesh(
        mesh.points[kept],
        cells,
        conditions,
        materials=materials,
        touching=(Touching(touching[kept], plane),),
    )
    return Half(axis, half, source, body != upper)


def expand(halves, displacement):
    """Displacement (n, 3) on the whole mesh from that on the smallest one of halve()."""
    for half in reversed(halves):
        displacement = half.expand(displacement)
    return displacement


def _half(mesh, axis):
    """The Half of a mesh on the upper side of an axis, or None if it lacks that symmetry."""
    size = np.ptp(mesh.points)
    low, high = mesh.points[:, axis].min(), mesh.points[:, axis].max()
    height = mesh.points[:, axis] - (low + high) / 2
    side = np.where(np.abs(height) < TOLERANCE * size, 0, np.sign(height)).astype(int)
    if (side[mesh.cells].max(axis=1) - side[mesh.cells].min(axis=1) == 2).any():
        return None  # the plane cuts through elements
    image_points = mesh.points.copy()
    image_points[:, axis] -= 2 * height
    distance, image = cKDTree(mesh.points).query(image_points)
    if distance.max() > TOLERANCE * size:
        return None
    if not np.array_equal(_as_sets(image[mesh.cells]), _as_sets(mesh.cells)):
        return None
    for condition in mesh.conditions:
        if condition.turn or not np.array_equal(condition.nodes[image], condition.nodes):
            return None
        for component in condition.components:
            value = np.where(condition.nodes, condition.values[:, component], 0.0)
            difference = value[image] - (-value if component == axis else value)
            if np.abs(difference).max() > TOLERANCE * size:
                return None
    if not all(_has_mirror(t, mesh, axis, side, image) for t in mesh.tractions):
        return None
    if mesh.surfaces or mesh.touching or mesh.gravity or mesh.masses or mesh.axes is not None:
        return None  # their conditions on a mirror plane are not implemented
    if mesh.materials is not None and not _same_materials(mesh, image):
        return None
    kept = np.flatnonzero(side >= 0)
    number = np.full(len(side), -1)
    number[kept] = np.arange(len(kept))
    kept_cells = (side[mesh.cells] >= 0).all(axis=1)
    cells = mesh.cells[kept_cells]
    materials = None if mesh.materials is None else mesh.materials[kept_cells]
    conditions = [Condition(c.nodes[kept], c.components, c.values[kept]) for c in mesh.conditions]
    conditions.append(Condition(side[kept] == 0, (axis,), np.zeros((len(kept), 3))))
    mirrored = side < 0
    source = number[np.where(mirrored, image, np.arange(len(side)))]
    tractions = tuple(replace(t, nodes=t.nodes[kept]) for t in mesh.tractions)
    half = HexMesh(mesh.points[kept], number[cells], tuple(conditions), tractions, materials)
    return Half(axis, half, source, mirrored)


def _has_mirror(traction, mesh, axis, side, image):
    """Whether a Traction is its own mirror image and none of its faces lies in the mirror plane."""
    if not np.array_equal(traction.nodes[image], traction.nodes):
        return False
    # A reflection reverses the normal component of a vector, but the tangential ones of a rotation.
    for part, whole in (
        (traction.mean[axis], traction.mean),
        (np.delete(traction.turn, axis), traction.turn),
    ):
        if np.abs(part).max() > TOLERANCE * np.abs(whole).max():
            return False
    faces = mesh.cells[:, FACES]  # (m, 6, 4)
    return not (traction.nodes[faces] & (side[faces] == 0)).all(axis=2).any()


def _same_materials(mesh, image):
    """Whether every cell of a HexMesh has the material of its mirror image."""
    own, mirrored = np.sort(mesh.cells, axis=1), np.sort(image[mesh.cells], axis=1)
    order, mirrored_order = np.lexsort(own.T), np.lexsort(mirrored.T)
    return np.array_equal(mesh.materials[order], mesh.materials[mirrored_order])


def _as_sets(cells):
    """Cells as sets of nodes in a canonical order, to compare meshes."""
    cells = np.sort(cells, axis=1)
    return cells[np.lexsort(cells.T)]
