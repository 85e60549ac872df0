"""Whether hexahedra are numbered as VTK does it: bottom counterclockwise, then the top above it."""

import numpy as np

TANGLED, RIGHT, MIRRORED = 0, 1, -1
MIRROR = [4, 5, 6, 7, 0, 1, 2, 3]  # top and bottom change places
LEXICOGRAPHIC = [0, 1, 3, 2, 4, 5, 7, 6]  # from x fastest, then y, then z

SIGNS = np.array(
    [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1)]
    + [(-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
)
# Counterclockwise seen from outside.
FACES = np.array(
    [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
)


def judge(points, cells):
    """RIGHT, MIRRORED or TANGLED for each cell: det dX/dxi at the eight Gauss points is above
    zero at all, below zero at all, or neither. points (n, 3), cells (m, 8)."""
    lowest, highest = np.full(len(cells), np.inf), np.full(len(cells), -np.inf)
    corners = points[cells]
    for xi in SIGNS / np.sqrt(3.0):
        factors = 1.0 + SIGNS * xi  # (8, 3)
        slopes = SIGNS * np.stack(
            [factors[:, (i + 1) % 3] * factors[:, (i + 2) % 3] / 8.0 for i in range(3)], axis=1
        )
        measure = np.linalg.det(np.einsum("mai,aj->mij", corners, slopes))
        lowest, highest = np.minimum(lowest, measure), np.maximum(highest, measure)
    return np.where(lowest > 0, RIGHT, np.where(highest < 0, MIRRORED, TANGLED))


def overlap(cells):
    """Two cells that do not lie on two sides of the face that they share, or None.

    cells: (m, 8), each of them RIGHT. Seen from both sides, the nodes of a face go round in
    opposite directions.
    """
    faces = cells[:, FACES].reshape(-1, 4)
    first = faces.argmin(axis=1)[:, None]
    a, b, c, d = np.take_along_axis(faces, (first + np.arange(4)) % 4, axis=1).T
    keys = np.stack([a, np.minimum(b, d), np.maximum(b, d), c], axis=1)
    order = np.lexsort(np.sort(keys, axis=1).T)
    same_nodes = (np.sort(keys, axis=1)[order][1:] == np.sort(keys, axis=1)[order][:-1]).all(axis=1)
    same_edges = (keys[order][1:] == keys[order][:-1]).all(axis=1)
    turned = (b < d)[order]
    third = np.zeros_like(same_nodes)
    third[1:] = same_nodes[1:] & same_nodes[:-1]
    wrong = third | (same_nodes & (~same_edges | (turned[1:] == turned[:-1])))
    if not wrong.any():
        return None
    at = int(np.flatnonzero(wrong)[0])
    return tuple(int(face) // 6 for face in order[at : at + 2])
