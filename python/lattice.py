"""Meshes of the tests that need no file."""

import numpy as np

from common.hexahedron import CUBE


def lattice(x, y, z):
    """Points (n, 3), cells (m, 8) and nodes [z, y, x] of hexahedra between planes at x, y, z, m."""
    depths, rows, columns = np.meshgrid(z, y, x, indexing="ij")
    nodes = np.arange(depths.size).reshape(depths.shape)
    layers, lines, places = np.subtract(nodes.shape, 1)
    cells = [nodes[k : k + layers, j : j + lines, i : i + places].ravel() for i, j, k in CUBE]
    points = np.stack([columns, rows, depths], axis=-1).reshape(-1, 3)
    return points, np.stack(cells, axis=-1), nodes
