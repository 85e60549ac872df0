"""Problems on meshes with hanging nodes: tied nodes follow others."""

import numpy as np
import scipy.sparse

from newton import Unknown


class TiedProblem:
    """A problem whose tied nodes follow others, as newton.solve() needs it, in the free dofs.

    problem: MixedProblem, or another program's, on a HexMesh with ties, which it ignores. With u =
    T q, residuals are T^T r and tangents T^T K T; q is zero at tied dofs.
    """

    def __init__(self, problem, ties):
        self._problem = problem
        tied, of, weights = ties
        self._dofs = dofs = problem.node_dofs()
        rows, columns = dofs[tied].ravel(), dofs[of].ravel()
        size = dofs.size
        kept = np.setdiff1d(np.arange(size), rows)
        entries = np.concatenate([np.repeat(weights, 3), np.ones(len(kept))])
        places = np.concatenate([rows, kept]), np.concatenate([columns, kept])
        self._follow = scipy.sparse.csr_matrix((entries, places), shape=(size, size))
        self.displacement = Unknown(size)
        self.pressure = problem.pressure
        self._of_fixed = np.isin(problem.fixed, kept)
        self.fixed = problem.fixed[self._of_fixed]
        self.free = np.intersect1d(problem.free, kept)
        self.scale, self.symmetric = problem.scale, problem.symmetric

    @property
    def program(self):
        """See SfepyProblem."""
        return self._problem.program

    @property
    def load(self):
        """The current factor of the loads, 0 to 1."""
        return self._problem.load

    @load.setter
    def load(self, load):
        self._problem.load = load

    def node_dofs(self):
        """See MixedProblem.node_dofs."""
        return self._dofs

    def values_at(self, load):
        """See MixedProblem.values_at."""
        return self._problem.values_at(load)[self._of_fixed]

    def multipliers(self):
        """See newton.Problem."""
        return self._problem.multipliers()

    def augment(self):
        """See newton.Problem."""
        self._move()
        return self._problem.augment()

    def nodal_displacement(self):
        """See MixedProblem.nodal_displacement."""
        self._move()
        return self._problem.nodal_displacement()

    def mixed_residual(self):
        """See MixedProblem.mixed_residual."""
        self._move()
        forces, dilatation = self._problem.mixed_residual()
        return self._follow.T @ forces, dilatation

    def linearize(self):
        """See MixedProblem.linearize."""
        self._move()
        tangent, residual, recover = self._problem.linearize()
        reduced = (self._follow.T @ tangent @ self._follow).tocsr()
        return reduced, self._follow.T @ residual, lambda du: recover(self._follow @ du)

    def _move(self):
        self._problem.displacement.x.array[:] = self._follow @ self.displacement.array
