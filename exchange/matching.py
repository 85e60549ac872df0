"""Finds the nodes of a mesh in another program's answer, by coordinates or ids."""

import numpy as np
from scipy.spatial import cKDTree

from common.errors import InputError

WORST = 5  # offenders listed in a message


def by_coordinates(points, found, tolerance, path):
    """Row of `found` for each of `points`: (n,). The nodes must correspond one to one.

    points: (n, 3) of the case, found: (m, 3) of the file, m. tolerance: largest distance between
    matching nodes over the diagonal of the case. Raises InputError naming the worst offenders.
    """
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    limit = tolerance * diagonal
    if found.shape == points.shape and (np.linalg.norm(found - points, axis=1) <= limit).all():
        return np.arange(len(points))  # also where bodies touch and nodes are at one place
    gaps, rows = cKDTree(found).query(points)
    far = np.flatnonzero(gaps > limit)
    sizes = f"{len(found)} nodes in the file, {len(points)} in the case"
    if far.size:
        worst = far[np.argsort(-gaps[far], kind="stable")][:WORST]
        places = ", ".join(f"{_place(points[n])} by {gaps[n] / diagonal:.2g}" for n in worst)
        raise InputError(
            f"{path}: {far.size} nodes of the case have no node of the file within "
            f"{tolerance:g} of the diagonal ({sizes}; diagonals "
            f"{np.linalg.norm(np.ptp(found, axis=0)):.6g} and {diagonal:.6g} m); the farthest: "
            f"{places}"
        )
    spare = np.setdiff1d(np.arange(len(found)), rows)
    if spare.size or len(np.unique(rows)) < len(rows):
        gaps, _ = cKDTree(points).query(found[spare]) if spare.size else (np.empty(0), None)
        worst = spare[np.argsort(-gaps, kind="stable")][:WORST]
        places = ", ".join(_place(found[n]) for n in worst) or "none"
        raise InputError(
            f"{path}: each node of the case must occur exactly once ({sizes}); unmatched or "
            f"repeated nodes of the file: {places}"
        )
    return rows


def by_ids(ids, n_nodes, path):
    """Row of each node: (n_nodes,). ids: of the rows, counted from 0 or from 1, each once.

    Raises InputError.
    """
    order = np.argsort(ids, kind="stable")
    for first in (0, 1):
        if np.array_equal(ids[order], np.arange(first, first + n_nodes)):
            return order
    raise InputError(
        f"{path}: ids {ids.min()} to {ids.max()} in {len(ids)} rows must be 0 to {n_nodes - 1} or "
        f"1 to {n_nodes}, each once, in the order of `sandglass mesh`; otherwise give x, y, z"
    )


def _place(point):
    return "(" + ", ".join(f"{x:.6g}" for x in point) + ")"
