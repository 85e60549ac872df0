"""The accuracy figures of the project, for two sets of nodal displacements."""

import numpy as np


def relative_errors(displacement, reference, largest_imposed):
    """Difference of two displacement fields (n, 3), in m, as fractions of the imposed one.

    largest_imposed: max over the prescribed nodes of |d|, m. Returns (max, rms) over all nodes of
    |u - u_ref| / largest_imposed.
    """
    distance = np.linalg.norm(displacement - reference, axis=1) / largest_imposed
    return distance.max(), np.sqrt((distance**2).mean())
