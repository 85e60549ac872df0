"""Checks that hexahedra are numbered as in VTK: bottom counterclockwise, then the top above it."""

import numpy as np

from common.hexahedron import FACES, gauss_jacobians

TANGLED, RIGHT, MIRRORED = 0, 1, -1
MIRROR = [4, 5, 6, 7, 0, 1, 2, 3]  # top and bottom change places


def classify(points, cells):
    """RIGHT, MIRRORED or TANGLED for each cell, (m,): det dX/dxi is positive at all eight Gauss
    points, negative at all, or neither. points: (n, 3), m. cells: (m, 8)."""
    found = gauss_jacobians(points, cells)
    right, mirrored = (found > 0).all(axis=0), (found < 0).all(axis=0)
    return np.where(right, RIGHT, np.where(mirrored, MIRRORED, TANGLED))


def overlap(cells):
    """Two cells that do not lie on opposite sides of their common face, or None.

    cells: (m, 8), each of them RIGHT. Cells on opposite sides of a face list its nodes in opposite
    directions.
    """
    faces = cells[:, FACES].reshape(-1, 4)
    first = faces.argmin(axis=1)[:, None]
    a, b, c, d = np.take_along_axis(faces, (first + np.arange(4)) % 4, axis=1).T
    keys = np.stack([a, np.minimum(b, d), np.maximum(b, d), c], axis=1)
    order = np.lexsort(np.sort(keys, axis=1).T)
    ordered, keys = np.sort(keys[order], axis=1), keys[order]
    same_nodes = (ordered[1:] == ordered[:-1]).all(axis=1)
    same_edges = (keys[1:] == keys[:-1]).all(axis=1)
    turned = (b < d)[order]
    third = np.zeros_like(same_nodes)
    third[1:] = same_nodes[1:] & same_nodes[:-1]
    wrong = third | (same_nodes & (~same_edges | (turned[1:] == turned[:-1])))
    if not wrong.any():
        return None
    at = int(np.flatnonzero(wrong)[0])
    return tuple(int(face) // 6 for face in order[at : at + 2])
