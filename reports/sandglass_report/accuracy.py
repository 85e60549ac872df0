"""The accuracy figures of the project, and the order of the nodes along a profile line."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Accuracy:
    """Distances of a displacement field from a reference, as fractions of the imposed one."""

    max: float  # over all nodes
    rms: float  # over all nodes
    profile: float | None  # largest on the case's profile line; None without one


def relative_distances(u, reference, unit):
    """|u - reference| / unit per node; u and reference (n, 3) in m, unit in m."""
    return np.linalg.norm(u - reference, axis=1) / unit


def accuracy(u, reference, unit, profile=None):
    """Accuracy of u (n, 3) against reference (n, 3), both in m.

    unit: largest imposed displacement, m. profile: node numbers of the profile line, or None.
    The formulas are those of solver/comparison/accuracy.cpp.
    """
    distances = relative_distances(u, reference, unit)
    return Accuracy(
        max=float(distances.max()),
        rms=float(np.sqrt(np.mean(distances**2))),
        profile=None if profile is None else float(distances[profile].max()),
    )


def ordered_profile(points, nodes, order):
    """The nodes of a profile line in order along it, and their coordinate.

    points: (n, 3) undeformed, m. nodes: node numbers. order: "x", "y", "z": by that coordinate
    (m); "around-x", ...: by the angle (degrees, -180..180) around that axis through the middle of
    the line, zero at the last of the other two axes, positive towards the first of them.
    Returns (nodes, coordinates).
    """
    nodes = np.asarray(nodes)
    at = points[nodes]
    if order in ("x", "y", "z"):
        along = at[:, "xyz".index(order)]
    else:
        first, last = (i for i in range(3) if i != "xyz".index(order[-1]))
        middle = (at.min(axis=0) + at.max(axis=0)) / 2
        arm = at - middle
        # Rounding noise in the first coordinate must not decide between -180 and +180 degrees.
        sideways = np.where(np.abs(arm[:, first]) < 1e-9 * np.ptp(at), 0.0, arm[:, first])
        along = np.degrees(np.arctan2(sideways, arm[:, last]))
    by_position = np.argsort(along, kind="stable")
    return nodes[by_position], along[by_position]


def is_closed(order):
    """Whether a profile line with this order goes around and ends where it began."""
    return order.startswith("around-")
