"""Cuts a mesh of trilinear hexahedra, with hanging nodes, into quadratic tetrahedra. Only numpy.

Faces agree between neighbours: one without hanging nodes is cut along the diagonal through its
lowest-numbered vertex; one with nodes on its edges is a fan around its centre; one whose other side
is split is cut part by part. A hexahedron without hanging nodes becomes six tetrahedra with a
common vertex, any other a fan around its centre. The ten nodes of a tetrahedron are placed by the
trilinear map of its hexahedron. On a face of a hexahedron, and on every plane through three of its
vertices in a box, that is the same surface: a bilinear map is quadratic along straight lines.
"""

import dataclasses

import numpy as np
from scipy.spatial import cKDTree

from common.hexahedron import CORNERS, FACES
from hexahedra import SPLIT_POINTS, Turn

# Nodes of a tetrahedron: four vertices, then the middles of these edges, as FEniCSx has them.
EDGES = np.array([(2, 3), (1, 3), (1, 2), (0, 3), (0, 2), (0, 1)])

# The places of a hexahedron's vertices, mid-edges, mid-faces and centre, by SPLIT_POINTS.
LATTICE = np.array(SPLIT_POINTS)
VERTICES = [SPLIT_POINTS.index(tuple(corner + 1)) for corner in CORNERS]
CENTRE = SPLIT_POINTS.index((1, 1, 1))

# A node within this share of the mesh's size of the middle of an edge or face hangs there.
TOLERANCE = 1e-9


def shapes(places):
    """Trilinear shape functions (k, 8), in VTK's order, at places (k, 3) between 0 and 2."""
    return np.prod(1 + CORNERS * (places[:, None, :] - 1), axis=2) / 8


def cut(mesh):
    """The tetrahedra of a HexMesh with or without hanging nodes (its ties are ignored).

    Returns a HexMesh whose cells (k, 10) are quadratic tetrahedra. The nodes of the hexahedra come
    first; a new one is in a set when all vertices of the smallest edge, face or cell of a
    hexahedron that holds it are, and its values are interpolated between them.
    """
    slots, n_vertices = _slots(mesh)
    cell, corners = _tetrahedra(slots)
    vertices = np.take_along_axis(slots[cell], corners, axis=1)
    pairs = np.sort(vertices[:, EDGES], axis=2)
    edges, first, number = np.unique(
        pairs.reshape(-1, 2), axis=0, return_index=True, return_inverse=True
    )
    middles = n_vertices + number.reshape(-1, 6)
    # The hexahedron and the place in it of every new node, vertices (of faces and cells) first.
    owner = np.empty(n_vertices + len(edges), dtype=int)
    place = np.empty((len(owner), 3))
    owner[vertices], place[vertices] = cell[:, None], LATTICE[corners]
    owner[n_vertices:] = cell[first // 6]
    place[n_vertices:] = LATTICE[corners][:, EDGES].mean(axis=2).reshape(-1, 3)[first]
    n_old = len(mesh.points)
    weights = shapes(place[n_old:])
    parents = mesh.cells[owner[n_old:]]

    def extend(of_nodes):
        return np.concatenate([of_nodes, np.einsum("kv,kv...->k...", weights, of_nodes[parents])])

    def extend_set(nodes):
        return np.concatenate([nodes, (nodes[parents] | (weights == 0)).all(axis=1)])

    def with_set(one):
        return dataclasses.replace(one, nodes=extend_set(one.nodes))

    conditions = tuple(
        dataclasses.replace(
            with_set(one),
            values=extend(one.values),
            turn=one.turn and Turn(one.turn.angle, extend(one.turn.versine), extend(one.turn.sine)),
        )
        for one in mesh.conditions
    )
    return dataclasses.replace(
        mesh,
        points=extend(mesh.points),
        cells=np.concatenate([vertices, middles], axis=1),
        conditions=conditions,
        tractions=tuple(map(with_set, mesh.tractions)),
        surfaces=tuple(map(with_set, mesh.surfaces)),
        touching=tuple(map(with_set, mesh.touching)),
        masses=tuple(map(with_set, mesh.masses)),
        materials=None if mesh.materials is None else mesh.materials[cell],
        axes=None if mesh.axes is None else mesh.axes[cell],
        ties=None,
    )


def _slots(mesh):
    """Nodes (m, 27) at the lattice of every hexahedron, -1 if there is none, and their number.

    First the mesh's nodes, then one for each face with nodes only on its edges, then one for each
    hexahedron with a hanging node.
    """
    corners = mesh.points[mesh.cells]
    found = cKDTree(mesh.points)
    slots = np.full((len(mesh.cells), 27), -1)
    for slot, place in enumerate(LATTICE):
        if slot != CENTRE:
            middles = np.einsum("v,mvj->mj", shapes(place[None].astype(float))[0], corners)
            distance, node = found.query(middles)
            near = distance < TOLERANCE * np.ptp(mesh.points)
            slots[near, slot] = node[near]
    slots[:, VERTICES] = mesh.cells
    fans, cells = [], []
    for face, (centre, mids, _) in zip(FACES, FACE_SLOTS):
        rows = np.flatnonzero((slots[:, centre] < 0) & (slots[:, mids] >= 0).any(axis=1))
        fans.append(np.sort(mesh.cells[rows][:, face], axis=1))
        cells.append(rows)
    _, number = np.unique(np.concatenate(fans), axis=0, return_inverse=True)
    n = len(mesh.points)
    new = np.split(n + number.ravel(), np.cumsum([len(rows) for rows in cells])[:-1])
    for (centre, _, _), rows, nodes in zip(FACE_SLOTS, cells, new):
        slots[rows, centre] = nodes
    n += number.max(initial=-1) + 1
    hanging = np.flatnonzero((slots >= 0).sum(axis=1) > 8)
    slots[hanging, CENTRE] = n + np.arange(len(hanging))
    return slots, n + len(hanging)


def _face_slots(face):
    """The lattice slots of a face (4 vertices): its centre, mid-edges (4,), vertices (4,)."""
    ring = LATTICE[np.array(VERTICES)[face]]
    middles = (ring + np.roll(ring, -1, axis=0)) // 2
    slots = [SPLIT_POINTS.index(tuple(p)) for p in [ring.sum(axis=0) // 4, *middles, *ring]]
    return slots[0], slots[1:5], slots[5:]


FACE_SLOTS = [_face_slots(face) for face in FACES]


def _tetrahedra(slots):
    """The tetrahedra of hexahedra with slots (m, 27): hexahedron (k,), slots of vertices (k, 4)."""
    lowest = np.array(VERTICES)[slots[:, VERTICES].argmin(axis=1)]
    apex = np.where(slots[:, CENTRE] >= 0, CENTRE, lowest)
    cells, triangles = [], []

    def add(rows, ring):
        """Two triangles of a quadrilateral, by the diagonal through its lowest node."""
        ring = np.array(ring)
        turn = slots[rows][:, ring].argmin(axis=1)
        turned = ring[(turn[:, None] + np.arange(4)) % 4]
        for corners in ((0, 1, 2), (0, 2, 3)):
            cells.append(rows)
            triangles.append(turned[:, corners])

    for centre, mids, ring in FACE_SLOTS:
        split = (slots[:, mids] >= 0).all(axis=1) & (slots[:, centre] >= 0)
        # A face with four nodes on its edges has a centre anyway: its own, or the one of the fan.
        # The parts of both are the same.
        fan = ~split & (slots[:, centre] >= 0)
        plain = np.flatnonzero(slots[:, centre] < 0)
        add(plain, ring)
        for i in range(4):
            add(np.flatnonzero(split), [ring[i], mids[i], centre, mids[i - 1]])
            whole = np.flatnonzero(fan & (slots[:, mids[i]] < 0))
            halved = np.flatnonzero(fan & (slots[:, mids[i]] >= 0))
            following = ring[(i + 1) % 4]
            for rows, side in (
                (whole, (ring[i], following)),
                (halved, (ring[i], mids[i])),
                (halved, (mids[i], following)),
            ):
                cells.append(rows)
                triangles.append(np.tile([*side, centre], (len(rows), 1)))
    cell, triangle = np.concatenate(cells), np.concatenate(triangles)
    seen = (triangle != apex[cell][:, None]).all(axis=1)
    cell, triangle = cell[seen], triangle[seen]
    corners = np.concatenate([apex[cell][:, None], triangle], axis=1)
    sides = LATTICE[corners[:, 1:]] - LATTICE[corners[:, :1]]
    volume = np.linalg.det(sides.astype(float))
    kept = np.abs(volume) > 0.1  # triangles of a face that contains the apex are coplanar with it
    corners[volume < 0] = corners[volume < 0][:, [0, 2, 1, 3]]
    order = np.argsort(cell[kept], kind="stable")
    return cell[kept][order], corners[kept][order]
