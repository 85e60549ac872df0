"""Rigid obstacles: signed distances from their shapes, with normals and curvatures. Only numpy.

A shape is a function of points x (k, 3), m, and, as keyword arguments, the entries of an
`[[obstacle]]` table that are its own, under the same names (SI). It returns the distance (k,) of
each point from the surface, m, negative inside, and its first and second derivatives: the normal
(k, 3) and the curvature (k, 3, 3), 1/m.

To add a shape, write its function and one entry in SHAPES.
"""

import inspect
from dataclasses import dataclass

import numpy as np


def plane(x, *, point, normal):
    """The half-space behind a point; the normal points out of it."""
    n = np.asarray(normal) / np.linalg.norm(normal)
    return (x - point) @ n, np.tile(n, (len(x), 1)), np.zeros((len(x), 3, 3))


def sphere(x, *, point, radius):
    """A ball about a point."""
    return _round(x - point, np.eye(3), radius)


def cylinder(x, *, point, end, radius):
    """A cylinder, infinite along the axis from a point to an end."""
    return _round_axis(x, point, end, radius, (-np.inf, np.inf))


def capsule(x, *, point, end, radius):
    """A cylinder with hemispherical ends, whose centres are a point and an end."""
    return _round_axis(x, point, end, radius, (0.0, 1.0))


def box(x, *, point, half_sizes):
    """A box about a point, along the axes of coordinates. Within it, the nearest face counts."""
    beyond = np.abs(x - point) - half_sizes
    side = np.where(x < np.asarray(point), -1.0, 1.0)
    outside = beyond.max(axis=1) > 0
    nearest = np.arange(3) == beyond.argmax(axis=1)[:, None]
    faces = np.where(outside[:, None], beyond > 0, nearest)  # those that the distance depends on
    across = faces[:, :, None] * np.eye(3)
    distance, normal, curvature = _round(side * np.where(faces, beyond, 0.0), across, 0.0)
    inside = ~outside
    distance[inside], curvature[inside] = beyond.max(axis=1)[inside], 0.0
    normal[inside] = (side * nearest)[inside]
    return distance, normal, curvature


def ellipsoid(x, *, point, half_sizes):
    """An ellipsoid about a point, along the axes of coordinates.

    The nearest point of the surface is y = x / (1 + t / a^2), the distance t |y / a^2|. Newton's
    method for t ascends from a lower bound, as the equation is convex and falls. It has no
    nearest point on the middle surface deep within.
    """
    a2 = np.asarray(half_sizes) ** 2
    x = x - point
    t = (np.sqrt(a2) * np.abs(x) - a2).max(axis=1, keepdims=True)
    for _ in range(60):
        y = x * a2 / (a2 + t)
        excess = (y**2 / a2).sum(axis=1, keepdims=True) - 1
        step = excess / (2 * y**2 / a2 / (a2 + t)).sum(axis=1, keepdims=True)
        t = t + step
        if (np.abs(step) < 1e-14 * a2.min()).all():
            break
    y = x * a2 / (a2 + t)
    slope = np.linalg.norm(y / a2, axis=1)
    normal = y / a2 / slope[:, None]
    along = np.eye(3) - normal[:, :, None] * normal[:, None, :]
    distance = t[:, 0] * slope
    at_surface = along @ (np.diag(1 / a2) / slope[:, None, None]) @ along
    # Surfaces at a distance d have the radii of curvature r + d.
    moved = np.eye(3) + distance[:, None, None] * at_surface
    return distance, normal, np.linalg.solve(moved, at_surface)


def _round_axis(x, point, end, radius, limits):
    """The distance from the part of an axis between limits, 0 at the point and 1 at the end."""
    axis = np.subtract(end, point)
    unit = axis / np.linalg.norm(axis)
    place = (x - point) @ axis / (axis @ axis)
    on_axis = np.clip(place, *limits)
    beside = (on_axis == place)[:, None, None]
    across = np.eye(3) - np.where(beside, np.outer(unit, unit), 0.0)
    return _round(x - point - on_axis[:, None] * axis, across, radius)


def _round(arm, across, radius):
    """The distance from what lies a radius from a point, line or face that arms (k, 3) end at.

    across: (k, 3, 3), the directions in which the arm grows.
    """
    length = np.linalg.norm(arm, axis=1)
    safe = np.where(length > 0, length, 1.0)[:, None]
    normal = arm / safe
    curvature = (across - normal[:, :, None] * normal[:, None, :]) / safe[:, :, None]
    return length - radius, normal, curvature


SHAPES = {shape.__name__: shape for shape in (plane, sphere, capsule, cylinder, box, ellipsoid)}


def shape_keys(shape):
    """The keys of a shape in an `[[obstacle]]` table."""
    return inspect.getfullargspec(SHAPES[shape]).kwonlyargs


@dataclass(frozen=True)
class Obstacle:
    """A rigid obstacle that the faces within a node set may touch, without friction.

    shape: a name in SHAPES. parameters: of its function. displacement: (3,) m, at full load.
    inside: whether the body is inside of it. penalty: the stiffness over Young's modulus / edge.
    limit: whether nothing penetrates it, whatever the penalty.
    """

    set_name: str
    shape: str
    parameters: dict
    displacement: tuple = (0.0, 0.0, 0.0)
    inside: bool = False
    penalty: float = 30.0
    limit: bool = True

    def gap(self, x, load):
        """Signed distances (k,) of points (k, 3), m, at a load factor, and their derivatives.

        Negative in the obstacle. Returns them, normals (k, 3) towards the body and curvatures
        (k, 3, 3), 1/m.
        """
        moved = x - load * np.asarray(self.displacement)
        sign = -1.0 if self.inside else 1.0
        return tuple(sign * part for part in SHAPES[self.shape](moved, **self.parameters))
