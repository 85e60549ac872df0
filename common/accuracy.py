"""The accuracy figures of the project, by the formulas of suite/comparison/accuracy.cpp."""

import numpy as np


def relative_distances(displacement, reference, unit):
    """Distance (n,) of two displacement fields (n, 3), m, at each node, over the unit.

    unit: the largest imposed displacement, max over the prescribed nodes of |d|, m.
    """
    return np.linalg.norm(displacement - reference, axis=1) / unit


def relative_errors(displacement, reference, unit):
    """(max, rms) over all nodes of relative_distances(), which takes the same fields (n, 3)."""
    distance = relative_distances(displacement, reference, unit)
    return distance.max(), np.sqrt((distance**2).mean())
