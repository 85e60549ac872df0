"""Meshes of trilinear hexahedra: vertex numbering, conditions, uniform subdivision. Only numpy."""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from common.hexahedron import LEXICOGRAPHIC, boundary_faces
from obstacles import Obstacle

# The 27 nodes of a cell split into eight, and the positions of its vertices among them, x fastest.
SPLIT_POINTS = [(i, j, k) for k in range(3) for j in range(3) for i in range(3)]
SPLIT_CORNERS = [(2 * i, 2 * j, 2 * k) for k in range(2) for j in range(2) for i in range(2)]


@dataclass(frozen=True)
class Turn:
    """A rigid rotation: each node is displaced by (1 - cos) versine + sin sine.

    angle: rad, at the full load. versine, sine: (n, 3) m.
    """

    angle: float
    versine: np.ndarray
    sine: np.ndarray

    def at(self, load):
        """Displacement (n, 3) in m at a load factor."""
        turned = load * self.angle
        return 2 * np.sin(turned / 2) ** 2 * self.versine + np.sin(turned) * self.sine

    def largest(self):
        """Largest displacement (n,) along the path, m: the longest chord of the arc."""
        chord = 2 * np.sin(min(abs(self.angle), np.pi) / 2)
        return chord * np.linalg.norm(self.versine, axis=1)


@dataclass(frozen=True)
class Condition:
    """Displacement components imposed on a set of nodes, proportional to the load.

    nodes: (n,) bool, True for the nodes of the set. components: axes (0..2) it acts on.
    values: (n, 3) m; only the rows of the set and the columns of the components are used.
    turn: a Turn imposed on the same components in addition, or None.
    """

    nodes: np.ndarray
    components: tuple
    values: np.ndarray
    turn: Turn | None = None

    def at(self, load):
        """Values (n, 3) in m at a load factor."""
        return load * self.values + (self.turn.at(load) if self.turn else 0.0)


@dataclass(frozen=True)
class Traction:
    """A dead traction mean + turn x (X - centre) on the boundary faces within a set of nodes.

    nodes: (n,) bool, True for the nodes of the set; it acts on faces with all vertices in it.
    mean: (3,) Pa. turn: (3,) Pa/m. centre: (3,) m. curve: as of case_file.Force.
    """

    nodes: np.ndarray
    mean: np.ndarray
    turn: np.ndarray
    centre: np.ndarray
    curve: Callable | None = None


@dataclass(frozen=True)
class Surface:
    """A pressure that follows the boundary faces within a set of nodes, and springs on them.

    nodes: (n,) bool, as of a Traction. pressure: Pa at full load, pushing. stiffness: Pa/m, of
    springs to the undeformed position; only_normal: only along the undeformed normal. curve: of the
    pressure, as in case_file.Force.
    """

    nodes: np.ndarray
    pressure: float = 0.0
    stiffness: float = 0.0
    only_normal: bool = False
    curve: Callable | None = None


@dataclass(frozen=True)
class Touching:
    """Nodes, (n,) bool, of boundary faces that may touch an Obstacle, as of a Traction."""

    nodes: np.ndarray
    obstacle: Obstacle


@dataclass(frozen=True)
class Attached:
    """A mass (kg) attached in equal shares to nodes (n,) bool."""

    nodes: np.ndarray
    total: float


@dataclass(frozen=True)
class HexMesh:
    """Trilinear hexahedra, the displacements imposed on their nodes, the tractions on faces.

    points: (n, 3) undeformed coordinates, m. cells: (m, 8) node numbers in VTK order.
    conditions: tuple of Condition. tractions: tuple of Traction. materials: (m,) the number of
    each element's material, or None if there is only one. surfaces: tuple of Surface. gravity:
    tuple of Gravity. axes: (m, 3, 3) material axes of each element by rows, or None. ties:
    (tied, of, weights) of k pairs of a tied node and one whose displacement it follows with that
    weight, or None. touching: tuple of Touching. masses: tuple of
    Attached. contacts: tuple of pairs of (n,) bool, nodes whose faces may touch each other; only
    symmetry.py knows them.
    """

    points: np.ndarray
    cells: np.ndarray
    conditions: tuple
    tractions: tuple = ()
    materials: np.ndarray | None = None
    surfaces: tuple = ()
    gravity: tuple = ()
    axes: np.ndarray | None = None
    ties: tuple | None = None
    touching: tuple = ()
    masses: tuple = ()
    contacts: tuple = ()

    def imposed(self, load=1.0):
        """All conditions at a load factor: (prescribed (n, 3) bool, values (n, 3) m, else zero)."""
        prescribed = np.zeros(self.points.shape, dtype=bool)
        values = np.zeros(self.points.shape)
        for condition in self.conditions:
            for axis in condition.components:
                prescribed[condition.nodes, axis] = True
                values[condition.nodes, axis] = condition.at(load)[condition.nodes, axis]
        return prescribed, values

    def acceleration(self):
        """The sum (3,) of all gravity at full load, m/s^2."""
        return np.sum([np.zeros(3), *(one.value for one in self.gravity)], axis=0)

    def largest_turn(self):
        """Largest displacement due to rotations alone, along the path: (n,) m."""
        largest = np.zeros(len(self.points))
        for condition in self.conditions:
            if condition.turn:
                chord = np.where(condition.nodes, condition.turn.largest(), 0.0)
                largest = np.maximum(largest, chord)
        return largest

    def largest_imposed(self):
        """Largest imposed displacement: max over the nodes of |d|, m.

        For rotating nodes, the largest along the path, with any added translation in full.
        """
        straight = tuple(dataclasses.replace(c, turn=None) for c in self.conditions)
        values = dataclasses.replace(self, conditions=straight).imposed()[1]
        return (np.linalg.norm(values, axis=1) + self.largest_turn()).max()


def traction(points, cells, nodes, total, moment):
    """The Traction whose sum is `total` (N) and whose moment about its centre is `moment` (N m).

    points: (n, 3) m. cells: (m, 8) VTK. nodes: (n,) bool. total, moment: (3,). Its centre is the
    centroid of the faces. Integrals by 2x2 Gauss points per face, as in solver/mesh/face_load.cpp.
    Returns None if no boundary face has all its vertices in nodes.
    """
    faces = boundary_faces(cells)
    corners = points[faces[nodes[faces].all(axis=1)]]  # (k, 4, 3)
    if not len(corners):
        return None
    signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    places, areas = [], []
    for xi, eta in signs / np.sqrt(3):
        values = (1 + signs[:, 0] * xi) * (1 + signs[:, 1] * eta) / 4
        by_xi = signs[:, 0] * (1 + signs[:, 1] * eta) / 4
        by_eta = signs[:, 1] * (1 + signs[:, 0] * xi) / 4
        sides = [np.einsum("i,kij->kj", weights, corners) for weights in (by_xi, by_eta)]
        places.append(np.einsum("i,kij->kj", values, corners))
        areas.append(np.linalg.norm(np.cross(*sides), axis=1))
    place, area = np.concatenate(places), np.concatenate(areas)
    centre = area @ place / area.sum()
    arm = place - centre
    inertia = (area * (arm**2).sum(axis=1)).sum() * np.eye(3) - (arm.T * area) @ arm
    return Traction(nodes, np.asarray(total) / area.sum(), np.linalg.solve(inertia, moment), centre)


def turn_about(points, axis, center, angle):
    """The Turn of points (n, 3) by an angle (rad) round an axis (3,) of length 1 through a center.

    With their arms r about the axis a, (R - 1)(X - c) = -(1 - cos) r + sin a x r.
    """
    from_center = points - center
    arm = from_center - np.outer(from_center @ axis, axis)
    return Turn(angle, -arm, np.cross(axis, arm))


def split_nodes(cells, n_nodes):
    """The nodes of split cells: ((m, 27), and for edges, faces and cells the parents (k, 2|4|8)).

    cells: (m, 8), lexicographic. n_nodes: of their mesh; new nodes are numbered from there.
    """
    # Each new node is the mean of the vertices that agree with it in every direction in which it
    # is not half-way.
    parents = [
        [v for v, corner in enumerate(SPLIT_CORNERS) if np.abs(np.subtract(p, corner)).max() <= 1]
        for p in SPLIT_POINTS
    ]
    local_to_global = np.empty((len(cells), 27), dtype=np.int64)
    local_to_global[:, [SPLIT_POINTS.index(corner) for corner in SPLIT_CORNERS]] = cells
    parents_of_new = []
    for n_parents in (2, 4, 8):  # edges, faces, cells
        slots = [s for s in range(27) if len(parents[s]) == n_parents]
        # Two cells share an edge or a face if and only if they share all its vertices.
        keys = np.sort(np.stack([cells[:, parents[s]] for s in slots], axis=1), axis=2)
        entities, number = np.unique(keys.reshape(-1, n_parents), axis=0, return_inverse=True)
        local_to_global[:, slots] = n_nodes + number.reshape(len(cells), len(slots))
        parents_of_new.append(entities)
        n_nodes += len(entities)
    return local_to_global, parents_of_new


def refine(mesh):
    """Split every hexahedron into eight through the images of its parent mid-points.

    The original nodes come first and keep their numbers; then one node per edge, per face and per
    cell. A new node is in the set of a condition when all vertices of its edge, face or cell are;
    its value is their mean, as the Q1 displacement of the coarse mesh has it there.

    mesh: HexMesh. Returns a HexMesh with 8 m cells of the same trilinear geometry; the children of
    cell c are the cells 8 c to 8 c + 7.
    """
    local_to_global, parents_of_new = split_nodes(mesh.cells[:, LEXICOGRAPHIC], len(mesh.points))

    def extend(of_nodes, reduce):
        return np.concatenate([of_nodes] + [reduce(of_nodes[e], axis=1) for e in parents_of_new])

    children = []
    for corner in SPLIT_CORNERS:
        offsets = [np.add(corner, other) // 2 for other in SPLIT_CORNERS]
        slots = [SPLIT_POINTS.index(tuple(offset)) for offset in offsets]
        children.append(local_to_global[:, slots][:, LEXICOGRAPHIC])

    def with_sets(loads):
        return tuple(dataclasses.replace(one, nodes=extend(one.nodes, np.all)) for one in loads)

    def extend_turn(turn):
        return turn and Turn(turn.angle, extend(turn.versine, np.mean), extend(turn.sine, np.mean))

    conditions = tuple(
        Condition(
            extend(c.nodes, np.all), c.components, extend(c.values, np.mean), extend_turn(c.turn)
        )
        for c in mesh.conditions
    )
    cells = np.stack(children, axis=1).reshape(-1, 8)
    materials, axes = (
        None if of_cells is None else np.repeat(of_cells, 8, axis=0)
        for of_cells in (mesh.materials, mesh.axes)
    )
    points = extend(mesh.points, np.mean)
    return dataclasses.replace(
        mesh,
        points=points,
        cells=cells,
        conditions=conditions,
        tractions=with_sets(mesh.tractions),
        surfaces=with_sets(mesh.surfaces),
        touching=with_sets(mesh.touching),
        masses=with_sets(mesh.masses),
        materials=materials,
        axes=axes,
        ties=None,
    )
