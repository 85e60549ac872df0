"""Contact of a body with a rigid obstacle: pressures at the nodes of its faces."""

import numpy as np
import scipy.sparse

# The augmented Lagrangian converges the faster the stiffer this is compared with the elements.
LIMIT_PENALTY = 100.0


class Contact:
    """The nodes of a body that may touch an Obstacle.

    A node with the area A of its shape function on the faces has the force A p n, p >= 0 the
    pressure on the undeformed area and n the obstacle's normal where the node is:
    p = max(0, multiplier - stiffness * gap). Without penetration the multiplier is that of the
    constraint gap >= 0: augment() improves it. With a penalty it is zero.

    obstacle: Obstacle. points: (n, 3) m, undeformed nodes in the order of the displacement. areas:
    (n,) m^2. modulus: smallest Young's modulus of the touching elements, Pa. edge: their shortest,
    m. Attributes: nodes (k,) that may touch, areas (k,), multipliers (k,) in Pa.
    """

    def __init__(self, obstacle, points, areas, modulus, edge):
        self.nodes = np.flatnonzero(areas > 1e-9 * areas.max())
        self.areas = areas[self.nodes]
        self.multipliers = np.zeros(len(self.nodes))
        self._obstacle, self._points = obstacle, points[self.nodes]
        penalty = LIMIT_PENALTY if obstacle.limit else obstacle.penalty
        self._stiffness = penalty * modulus / edge
        self._size = 3 * len(points)

    def state(self, u, load):
        """(gaps (k,) in m, pressures (k,) in Pa, normals (k, 3)) at a displacement (3 n,)."""
        gap, pressure, normal, _ = self._state(u, load)
        return gap, pressure, normal

    def forces(self, u, load):
        """Minus the forces (3 n,) in N of the obstacle on the body."""
        _, pressure, normal, _ = self._state(u, load)
        forces = np.zeros((self._size // 3, 3))
        forces[self.nodes] = -(self.areas * pressure)[:, None] * normal
        return forces.ravel()

    def tangent(self, u, load):
        """The derivative (3 n, 3 n) of forces() by the displacement, N/m."""
        _, pressure, normal, curvature = self._state(u, load)
        stiffness = self._stiffness * normal[:, :, None] * normal[:, None, :]
        blocks = stiffness - pressure[:, None, None] * curvature
        blocks *= (self.areas * (pressure > 0))[:, None, None]
        dofs = 3 * self.nodes[:, None] + np.arange(3)
        rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
        entries = blocks.ravel(), (rows.ravel(), columns.ravel())
        return scipy.sparse.csr_matrix(entries, shape=(self._size, self._size))

    def augment(self, u, load):
        """Makes the present pressures the multipliers, unless a penalty decides.

        Returns the largest change over the stiffness, m: a penetration, or how far a multiplier
        acted at a distance.
        """
        if not self._obstacle.limit:
            return 0.0
        pressure = self._state(u, load)[1]
        change = np.abs(pressure - self.multipliers).max() / self._stiffness
        self.multipliers[:] = pressure
        return change

    def _state(self, u, load):
        x = self._points + u.reshape(-1, 3)[self.nodes]
        gap, normal, curvature = self._obstacle.gap(x, load)
        return gap, np.maximum(0.0, self.multipliers - self._stiffness * gap), normal, curvature
