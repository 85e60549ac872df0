"""The accuracy figures of the project, by the formulas of solver/comparison/accuracy.cpp."""

import numpy as np


def relative_distances(displacement, reference, largest_imposed):
    """Distance (n,) of two displacement fields (n, 3), m, as fractions of the imposed one.

    largest_imposed: max over the prescribed nodes of |d|, m.
    """
    return np.linalg.norm(displacement - reference, axis=1) / largest_imposed


def relative_errors(displacement, reference, largest_imposed):
    """(max, rms) over all nodes of relative_distances()."""
    distance = relative_distances(displacement, reference, largest_imposed)
    return distance.max(), np.sqrt((distance**2).mean())
