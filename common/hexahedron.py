"""The hexahedron of eight nodes in VTK's order: bottom counterclockwise, then the top above it."""

import numpy as np

CORNERS = np.array(
    [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1)]
    + [(-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
)
CUBE = (CORNERS + 1) // 2  # of edges of one, on the planes of coordinates
# Counterclockwise seen from outside.
FACES = np.array(
    [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
)
# The corners with x fastest, then y, then z. It is its own inverse: it swaps 2 with 3 and 6 with 7.
LEXICOGRAPHIC = np.array([0, 1, 3, 2, 4, 5, 7, 6])


def boundary_faces(cells):
    """Nodes (k, 4) of the faces that belong to one cell only, outward, in the order of the cells.

    cells: (m, 8).
    """
    faces = np.asarray(cells)[:, FACES].reshape(-1, 4)
    _, first, count = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    return faces[np.sort(first[count == 1])]


def gauss_jacobians(points, cells):
    """det dX/dxi at the 2x2x2 Gauss points of trilinear hexahedra: (8, m), m^3.

    Their sum is exactly the volume, as det J is quadratic in each direction. points: (n, 3), m.
    cells: (m, 8).
    """
    corners = points[cells]
    found = np.empty((8, len(cells)))
    for at, xi in enumerate(CORNERS / np.sqrt(3.0)):
        factors = 1.0 + CORNERS * xi  # (8, 3)
        slopes = CORNERS * np.stack(
            [factors[:, (i + 1) % 3] * factors[:, (i + 2) % 3] / 8.0 for i in range(3)], axis=1
        )
        found[at] = np.linalg.det(np.einsum("mai,aj->mij", corners, slopes))
    return found
