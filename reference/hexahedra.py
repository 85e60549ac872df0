"""Meshes of trilinear hexahedra: vertex numbering, conditions, uniform subdivision. Only numpy."""

from dataclasses import dataclass

import numpy as np

# Local vertices of a VTK hexahedron in the lexicographic order of FEniCSx (x fastest). The
# permutation is its own inverse: it only swaps 2 with 3 and 6 with 7.
VTK_TO_LEXICOGRAPHIC = np.array([0, 1, 3, 2, 4, 5, 7, 6])


@dataclass(frozen=True)
class Condition:
    """Displacement components imposed on a set of nodes.

    nodes: (n,) bool, True for the nodes of the set. components: axes (0..2) it acts on.
    values: (n, 3) m; only the rows of the set and the columns of the components mean something.
    """

    nodes: np.ndarray
    components: tuple
    values: np.ndarray


@dataclass(frozen=True)
class HexMesh:
    """Trilinear hexahedra and the displacements imposed on their nodes.

    points: (n, 3) undeformed coordinates, m. cells: (m, 8) node numbers in VTK order.
    conditions: tuple of Condition.
    """

    points: np.ndarray
    cells: np.ndarray
    conditions: tuple

    def imposed(self):
        """All conditions together: (prescribed (n, 3) bool, values (n, 3) m, zero elsewhere)."""
        prescribed = np.zeros(self.points.shape, dtype=bool)
        values = np.zeros(self.points.shape)
        for condition in self.conditions:
            for axis in condition.components:
                prescribed[condition.nodes, axis] = True
                values[condition.nodes, axis] = condition.values[condition.nodes, axis]
        return prescribed, values

    def largest_imposed(self):
        """Largest imposed displacement: max over the nodes of |d|, m."""
        return np.linalg.norm(self.imposed()[1], axis=1).max()


def refine(mesh):
    """Split every hexahedron into eight through the images of its parent mid-points.

    The original nodes come first and keep their numbers; then one node per edge, per face and per
    cell. A new node is in the set of a condition when all vertices of its edge, face or cell are,
    with their mean value: that is what the Q1 displacement of the coarse mesh does there.

    mesh: HexMesh. Returns a HexMesh with 8 m cells of the same trilinear geometry; the children of
    cell c are the cells 8 c to 8 c + 7.
    """
    cells = mesh.cells[:, VTK_TO_LEXICOGRAPHIC]
    n_cells = len(cells)
    # The 27 points of a subdivided cell, and the vertices of which each is the mean: those that
    # agree with it in every direction in which it is not half-way.
    positions = [(i, j, k) for k in range(3) for j in range(3) for i in range(3)]
    corners = [(2 * i, 2 * j, 2 * k) for k in range(2) for j in range(2) for i in range(2)]
    parents = [
        [v for v, corner in enumerate(corners) if np.abs(np.subtract(p, corner)).max() <= 1]
        for p in positions
    ]
    local_to_global = np.empty((n_cells, 27), dtype=np.int64)
    local_to_global[:, [positions.index(corner) for corner in corners]] = cells
    n_nodes = len(mesh.points)
    parents_of_new = []
    for n_parents in (2, 4, 8):  # edges, faces, cells
        slots = [s for s in range(27) if len(parents[s]) == n_parents]
        # Two cells share an edge or a face exactly when they share its set of vertices.
        keys = np.sort(np.stack([cells[:, parents[s]] for s in slots], axis=1), axis=2)
        entities, number = np.unique(keys.reshape(-1, n_parents), axis=0, return_inverse=True)
        local_to_global[:, slots] = n_nodes + number.reshape(n_cells, len(slots))
        parents_of_new.append(entities)
        n_nodes += len(entities)

    def extend(of_nodes, reduce):
        return np.concatenate([of_nodes] + [reduce(of_nodes[e], axis=1) for e in parents_of_new])

    children = []
    for corner in corners:
        offsets = [np.add(corner, other) // 2 for other in corners]
        slots = [positions.index(tuple(offset)) for offset in offsets]
        children.append(local_to_global[:, slots][:, VTK_TO_LEXICOGRAPHIC])
    conditions = tuple(
        Condition(extend(c.nodes, np.all), c.components, extend(c.values, np.mean))
        for c in mesh.conditions
    )
    cells = np.stack(children, axis=1).reshape(-1, 8)
    return HexMesh(extend(mesh.points, np.mean), cells, conditions)
