"""The project's accuracy figures, and the order of nodes along a profile line."""

from dataclasses import dataclass

import numpy as np

from common.accuracy import relative_distances, relative_errors
from common.records import key


@dataclass(frozen=True)
class Accuracy:
    """Distances of a displacement field from a reference, as fractions of the imposed one."""

    max: float = key("max_relative_error")  # over all nodes
    rms: float = key("rms_relative_error")  # over all nodes
    profile: float | None = key("profile_relative_error")  # on the profile line; None without one


def accuracy(u, reference, unit, profile=None):
    """Accuracy of u (n, 3) against reference (n, 3), both in m.

    unit: largest imposed displacement, m. profile: node numbers of the profile line, or None.
    """
    largest, rms = relative_errors(u, reference, unit)
    on_line = None if profile is None else relative_distances(u, reference, unit)[profile].max()
    return Accuracy(float(largest), float(rms), None if on_line is None else float(on_line))


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
