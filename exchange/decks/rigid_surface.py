"""Obstacles as surfaces of triangles, for programs that know no shapes.

A curved shape is a polyhedron with its corners on the shape. Where the body is pressed in, its
chords err by at most CHORD of the depth; farther away, by as much of the distance from the body.
"""

import math

import numpy as np

from common.errors import InputError
from common.hexahedron import CORNERS, FACES

CHORD = 0.01
ROUNDING = 1e-6  # of coordinates in files, over an edge
MOST_TRIANGLES = 200_000
LATTICE = 8  # points on each edge of a face, less one, to which distances are measured
NEWTON = 30  # steps
HEIGHT = 0.1  # of the elements behind the surface, over an edge; they do not deform
# Two triangles of each face of a cube, outward.
_CUBE = np.vstack([FACES[:, [0, 1, 2]], FACES[:, [0, 2, 3]]])


def parts(problem):
    """(nodes (n, 3) in m, cells (k, 4)) of each obstacle of a Problem as `tetrahedra`; nodes are
    numbered on from those of the mesh and of the obstacles before.
    """
    found, first = [], len(problem.mesh.points)
    for obstacle in problem.obstacles:
        nodes, cells = tetrahedra(obstacle, problem.mesh.points, depth_of(obstacle, problem))
        found.append((nodes, cells + first))
        first += len(nodes)
    return found


def tetrahedra(obstacle, points, depth):
    """(nodes (n, 3) in m, cells (k, 4)): an element behind each triangle of the surface of an
    Obstacle, its first three nodes, clockwise seen from the body; the fourth is its own.

    points: (n, 3) of the undeformed body, m. depth: to which the body is pressed in, m.
    """
    corners, triangles = triangulated(obstacle, points, depth)
    if not obstacle.inside:
        triangles = triangles[:, ::-1]
    p = corners[triangles]
    normals = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    edges = np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2)
    behind = p.mean(axis=1) + HEIGHT * edges.min(axis=1)[:, None] * normals
    own = len(corners) + np.arange(len(triangles))
    nodes = np.vstack([corners, behind])
    digits = 12 - math.ceil(math.log10(np.abs(nodes).max()))  # so that all processors agree
    return nodes.round(digits), np.column_stack([triangles, own])


def depth_of(obstacle, problem):
    """How deep an Obstacle is pressed in (m): how far it overlaps the undeformed body at its end;
    if it does not, the largest imposed displacement; without one, the shortest edge it touches.
    """
    edge = shortest_edge(obstacle.faces, problem.mesh.points)
    imposed = np.abs(problem.values[problem.prescribed]).max(initial=0.0)
    return next(depth for depth in (obstacle.overlap, imposed, edge) if depth > ROUNDING * edge)


def shortest_edge(faces, points):
    """Of faces (f, 4), m."""
    edges = points[faces] - points[np.roll(faces, 1, axis=1)]
    return np.linalg.norm(edges, axis=2).min()


def triangulated(obstacle, points, depth):
    """(corners (n, 3) in m, triangles (k, 3), outward) of the surface of an Obstacle; of planes and
    cylinders, the part that a body of these points (n, 3) can reach.

    Raises InputError if it takes more than MOST_TRIANGLES.
    """
    from scipy.spatial import cKDTree  # takes long to load

    corners, triangles, onto = _start(obstacle, points)
    corners = onto(corners)
    samples, reach = _samples(obstacle.faces, points)
    tree = cKDTree(samples)
    while True:
        edges = np.sort(np.vstack([triangles[:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
        edges, number = np.unique(edges, axis=0, return_inverse=True)
        number = number.reshape(3, -1).T  # of the edges of each triangle
        middle = corners[edges].mean(axis=1)
        placed = onto(middle)
        distance, nearest = tree.query(placed + obstacle.displacement)
        allowed = CHORD * np.maximum(depth, distance - reach[nearest])
        split = np.linalg.norm(placed - middle, axis=1) > allowed
        if not split.any():
            return corners, triangles
        if len(triangles) + split[number].sum() > MOST_TRIANGLES:
            raise InputError(
                f"{obstacle.words}: as a surface of triangles it needs over {MOST_TRIANGLES}: "
                f"its chords are {CHORD * depth:.3g} m, a hundredth of its depth; allowed: a "
                "deeper or a smaller one, or a set of the body near it"
            )
        middles = np.where(split, len(corners) + split.cumsum() - 1, -1)
        triangles, corners = _split(triangles, middles[number]), np.vstack([corners, placed[split]])


def _samples(faces, points):
    """(points, half their distance) of a lattice on each face (f, 4), m."""
    t = np.linspace(0.0, 1.0, LATTICE + 1)
    x, y = (one.ravel() for one in np.meshgrid(t, t))
    shapes = np.stack([(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y])
    p = points[faces]
    diagonal = np.linalg.norm(p[:, :2] - p[:, 2:], axis=2).max(axis=1)
    samples = np.einsum("ks,fki->fsi", shapes, p)
    return samples.reshape(-1, 3), np.repeat(diagonal / LATTICE / 2, len(x))


def _split(triangles, middles):
    """Triangles (k, 3) with the nodes in the middles (k, 3) of their edges, -1 for none."""
    parts = []
    for corner, middle in zip(triangles.tolist(), middles.tolist()):
        given = [k for k in range(3) if middle[k] >= 0]
        if not given:
            parts.append(corner)
            continue
        # Begins such that its first edge is split, and of two split edges the last is not.
        first = next(k for k in given if len(given) != 2 or middle[k - 1] < 0)
        a, b, c = corner[first:] + corner[:first]
        ab, bc, ca = middle[first:] + middle[:first]
        if len(given) == 1:
            parts += [[a, ab, c], [ab, b, c]]
        elif len(given) == 2:
            parts += [[ab, b, bc], [a, ab, bc], [a, bc, c]]
        else:
            parts += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    return np.array(parts)


def _start(obstacle, points):
    """(corners, triangles, onto) of a coarse surface; onto maps points onto the shape."""
    if obstacle.shape == "surface":
        return obstacle.point + obstacle.points, obstacle.triangles, lambda x: x
    if obstacle.shape == "box":
        return obstacle.point + CORNERS * obstacle.half_sizes, _CUBE, lambda x: x
    if obstacle.shape == "ellipsoid":
        corners = obstacle.point + CORNERS * obstacle.half_sizes / math.sqrt(3.0)
        return corners, _CUBE, lambda x: _onto_ellipsoid(obstacle, x)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    far = np.linalg.norm(np.ptp(points, axis=0)) + np.linalg.norm(obstacle.displacement)
    if obstacle.shape == "plane":
        normal = obstacle.normal / np.linalg.norm(obstacle.normal)
        frame = _frame(normal)
        middle = middle + normal * ((obstacle.point - middle) @ normal)
        corners = middle + far * (CORNERS[4:, :2] @ frame[:2])
        return corners, _CUBE[[1, 7]] - 4, lambda x: x
    axis = obstacle.end - obstacle.point
    length = np.linalg.norm(axis) if obstacle.shape != "sphere" else 0.0
    frame = _frame(axis / length) if length else np.eye(3)
    low, high = np.array([0.0, length]) + np.array([-1.0, 1.0]) * obstacle.radius
    if obstacle.shape == "cylinder":
        low, high = (middle - obstacle.point) @ frame[2] + np.array([-far, far])
    along = np.where(CORNERS[:, 2] < 0, low, high)
    corners = np.column_stack([CORNERS[:, :2] * obstacle.radius, along]) @ frame + obstacle.point
    # A cylinder has no ends.
    triangles = np.delete(_CUBE, [0, 1, 6, 7], axis=0) if obstacle.shape == "cylinder" else _CUBE
    return corners, triangles, lambda x: _onto_round(obstacle, x)


def _frame(axis):
    """Three directions (3, 3) by rows, the last of them an axis of length one."""
    other = np.eye(3)[np.abs(axis).argmin()]
    first = np.cross(other, axis)
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(axis, first), axis])


def _feet(obstacle, x):
    """The closest points (n, 3) of the axis of a sphere, capsule or cylinder."""
    if obstacle.shape == "sphere":
        return np.broadcast_to(obstacle.point, x.shape)
    axis = obstacle.end - obstacle.point
    t = (x - obstacle.point) @ axis / (axis @ axis)
    if obstacle.shape == "capsule":
        t = t.clip(0.0, 1.0)
    return obstacle.point + t[:, None] * axis


def _onto_round(obstacle, x):
    feet = _feet(obstacle, x)
    arm = x - feet
    return feet + arm * (obstacle.radius / np.linalg.norm(arm, axis=1))[:, None]


def _onto_ellipsoid(obstacle, x):
    """The closest points (n, 3), a^2 x / (a^2 + t): Newton's method ascends to t from below. Points
    in a plane of symmetry get points in it."""
    a, arm = obstacle.half_sizes, x - obstacle.point
    t = (a * (np.abs(arm) - a)).max(axis=1)
    for _ in range(NEWTON):
        below = np.maximum(a**2 + t[:, None], ROUNDING**2 * a**2)
        squares = (a * arm / below) ** 2
        step = (squares.sum(axis=1) - 1) / (2 * squares / below).sum(axis=1)
        t += np.maximum(step, 0.0)
    near = arm / below
    return obstacle.point + a * (a * near / np.linalg.norm(a * near, axis=1)[:, None])
