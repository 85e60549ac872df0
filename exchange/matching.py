"""Finding the nodes of a mesh in another program's answer: by their coordinates."""

import numpy as np
from scipy.spatial import cKDTree

from common.errors import InputError

WORST = 5  # offenders that are told


def by_coordinates(points, found, tolerance, path):
    """Row of `found` for each of `points`: (n,). Each node is to be found once.

    points: (n, 3) of the case, found: (m, 3) of the file, m. tolerance: distance that is none, as a
    fraction of the diagonal of the case's nodes. Raises InputError naming the worst offenders.
    """
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    limit = tolerance * diagonal
    gaps, rows = cKDTree(found).query(points)
    far = np.flatnonzero(gaps > limit)
    sizes = f"{len(found)} nodes in the file, {len(points)} in the case"
    if far.size:
        worst = far[np.argsort(-gaps[far], kind="stable")][:WORST]
        told = ", ".join(f"{_place(points[n])} by {gaps[n] / diagonal:.2g}" for n in worst)
        raise InputError(
            f"{path}: {far.size} nodes of the case are in the file at no distance below "
            f"{tolerance:g} of the diagonal ({sizes}; diagonals "
            f"{np.linalg.norm(np.ptp(found, axis=0)):.6g} and {diagonal:.6g} m); the farthest: "
            f"{told}"
        )
    spare = np.setdiff1d(np.arange(len(found)), rows)
    if spare.size or len(np.unique(rows)) < len(rows):
        gaps, _ = cKDTree(points).query(found[spare]) if spare.size else (np.empty(0), None)
        worst = spare[np.argsort(-gaps, kind="stable")][:WORST]
        told = ", ".join(_place(found[n]) for n in worst) or "none to spare"
        raise InputError(
            f"{path}: each node of the case must be there once ({sizes}); those that are nobody's "
            f"or another's: {told}"
        )
    return rows


def by_ids(ids, n_nodes, path):
    """Row of each node: (n_nodes,). ids: of the rows, from 0 or from 1 on, each once.

    Raises InputError.
    """
    order = np.argsort(ids, kind="stable")
    for first in (0, 1):
        if np.array_equal(ids[order], np.arange(first, first + n_nodes)):
            return order
    raise InputError(
        f"{path}: ids {ids.min()} to {ids.max()} in {len(ids)} rows; required are 0 to "
        f"{n_nodes - 1}, or 1 to {n_nodes}, each once, in the order of `sandglass mesh`; else give "
        "x, y, z"
    )


def _place(point):
    return "(" + ", ".join(f"{x:.6g}" for x in point) + ")"
