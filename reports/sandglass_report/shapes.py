"""Deformed bodies as pictures: the surface of a hexahedral mesh, projected, sorted and shaded.

A parallel projection with the painter's algorithm on the boundary faces only. Unlike mplot3d, it
uses the same scale in all three directions, and several bodies can share one scale.
"""

from dataclasses import dataclass

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb

LIGHT = np.array([-0.45, -0.55, 0.70]) / np.linalg.norm(
    [-0.45, -0.55, 0.70]
)  # from the viewer's left


@dataclass(frozen=True)
class View:
    """Viewing direction by azimuth and elevation, degrees: 0, 0 looks along +y, x to the right."""

    azimuth: float
    elevation: float

    def axes(self):
        """Rows: right, up and towards the viewer, unit vectors."""
        a, e = np.radians([self.azimuth, self.elevation])
        right = np.array([np.cos(a), np.sin(a), 0.0])
        towards = np.array([np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), np.sin(e)])
        return np.array([right, np.cross(towards, right), towards])

    def project(self, points):
        """(n, 2) picture coordinates and (n,) nearness to the viewer, in the points' unit."""
        turned = points @ self.axes().T
        return turned[:, :2], turned[:, 2]


def draw_surface(axes, points, faces, view, colour, marked=(), sound=False):
    """Draws a surface into an Axes.

    points: (n, 3), m, deformed. faces: (k, 4) node numbers. colour: of the body. marked: pairs
    (node set, colour): faces whose four nodes are all in the set have that colour. sound: no
    element is inverted, so that faces directed away from the viewer can be left out.
    """
    flat, near = view.project(points)
    colours = np.tile(to_rgb(colour), (len(faces), 1))
    for nodes, mark in marked:
        colours[np.isin(faces, nodes).all(axis=1)] = to_rgb(mark)
    corners = points[faces]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    # A tangled body shows its inside; both sides are lit, so that it still looks like a surface.
    facing = np.sign(normal @ view.axes()[2])[:, None]
    light = LIGHT @ np.array([view.axes()[0], -view.axes()[2], view.axes()[1]])
    brightness = 0.70 + 0.32 * np.clip((facing * normal) @ light, 0, 1)
    order = np.argsort(near[faces].mean(axis=1))
    if sound:
        order = order[facing[order, 0] > 0]
    shaded = np.minimum(colours * brightness[:, None], 1.0)
    axes.add_collection(
        PolyCollection(
            flat[faces][order],
            facecolors=shaded[order],
            edgecolors=shaded[order] * 0.62,
            linewidths=0.35,
            joinstyle="round",
        )
    )


def window(bodies, view, margin=0.04):
    """Limits ((2,) low, (2,) high) of a picture of all bodies (list of (n, 3) points)."""
    flat = np.vstack([view.project(points)[0] for points in bodies])
    low, high = flat.min(axis=0), flat.max(axis=0)
    pad = margin * (high - low).max()
    return low - pad, high + pad


def frame(axes, limits):
    """Sets equal scales and the limits of `window`; hides the axes."""
    axes.set_xlim(limits[0][0], limits[1][0])
    axes.set_ylim(limits[0][1], limits[1][1])
    axes.set_aspect("equal")
    axes.set_axis_off()
