"""Load stepping and Newton's method with a sparse direct solver (MUMPS)."""

import sys
import time
from dataclasses import dataclass

import numpy as np
import scipy.sparse
from petsc4py import PETSc

from common.errors import ComputationError

MAX_ITERATIONS = 20
MAX_AUGMENTATIONS = 50
# A load step must only reach the next one's basin of convergence; the last is exact to round-off.
STEP_TOLERANCE = 1e-3
SMALLEST_STEP = 1 / 4096
SMALLEST_FRACTION = 1 / 16
# A correction this many times longer than the whole load does not lead to an equilibrium.
LARGEST_CORRECTION = 10.0


@dataclass(frozen=True)
class Outcome:
    """Cost and accuracy of a solution.

    residual: norm of the unbalanced nodal forces over the norm of the reactions.
    last_correction: largest component of the last Newton correction over the largest imposed
    component or, if none is imposed, over the largest component of the displacement.
    """

    load_steps: int
    newton_iterations: int
    residual: float
    last_correction: float


class Unknown:
    """An array under the name that solve() uses, for problems of other programs."""

    def __init__(self, size):
        self.x = self
        self.array = np.zeros(size)


class Problem:
    """The interface that solve() needs of any problem on a HexMesh: which unknowns are imposed.

    Attributes: fixed (prescribed unknowns), free (the others), scale (the largest displacement
    imposed on the way, m), load (the current factor of the loads, 0 to 1).
    """

    def impose(self, mesh, dofs, size):
        """Sets them. dofs: (n, 3) the unknowns of the mesh's nodes. size: number of unknowns."""
        self._mesh, self._dofs = mesh, dofs
        self._prescribed, values = mesh.imposed()
        self.fixed = dofs[self._prescribed]
        self.free = np.setdiff1d(np.arange(size), self.fixed)
        imposed = np.abs(values[self._prescribed]).max(initial=0.0)
        self.scale, self.load = max(imposed, mesh.largest_turn().max()), 1.0

    def values_at(self, load):
        """Values (in m) of the prescribed unknowns at a load factor."""
        return self._mesh.imposed(load)[1][self._prescribed]

    def multipliers(self):
        """The arrays of contact's multipliers, which augment() changes."""
        return ()

    def augment(self):
        """Improves the multipliers of contact. Returns the largest change as a length, m."""
        return 0.0

    def node_dofs(self):
        """The numbers (n, 3) of the displacement unknowns of the HexMesh's nodes."""
        return self._dofs


def condensed(blocks, force, dilatation):
    """(tangent, residual, recover) of a mixed system whose pressures are local to elements.

    blocks: the sparse matrices uu, up, pu and pp, of which the last is diagonal. force,
    dilatation: both rows of the residual. recover: from a displacement increment to the pressure
    increment of the same Newton step.
    """
    uu, up, pu, pp = blocks
    inverse = scipy.sparse.diags(1 / pp.diagonal())
    eliminated = up @ inverse

    def recover(increment):
        return -(inverse @ (dilatation + pu @ increment))

    return (uu - eliminated @ pu).tocsr(), force - eliminated @ dilatation, recover


def solve(problem, load_steps, tolerance, guessed=False):
    """Bring a MixedProblem to its prescribed displacement and load, in place.

    problem: MixedProblem, undeformed or, if guessed, near the answer; if Newton's method fails
    there, it starts again undeformed. load_steps: number of equal load steps; a step that fails is
    halved. tolerance: the last step ends when a Newton correction is below tolerance times the
    largest imposed component or, if none is imposed, the largest component of the displacement.
    Newton's method converges quadratically, so the solution is then exact to round-off. Returns an
    Outcome. Raises ComputationError if halving does not help.
    """
    scale = problem.scale
    state = (problem.displacement.x.array, problem.pressure.x.array, *problem.multipliers())
    balanced = [np.zeros_like(array) for array in state]  # the last equilibrium: undeformed
    load, steps, iterations = 0.0, 0, 0
    step = 1.0 if guessed else 1 / load_steps
    while load < 1:
        target = 1.0 if load + step > 1 - 1e-9 else load + step
        started = time.perf_counter()
        limit = tolerance if target == 1 else STEP_TOLERANCE
        converged, count, residual, correction = _settle(problem, target, scale, limit)
        iterations += count
        _report(target, converged, count, residual, correction, time.perf_counter() - started)
        if converged:
            load, steps = target, steps + 1
            balanced = [array.copy() for array in state]
            step = min(2 * step, 1 / load_steps)
            continue
        for array, value in zip(state, balanced):
            array[:] = value
        step = min((target - load) / 2, 1 / load_steps)
        if step < SMALLEST_STEP:
            raise ComputationError(
                f"no equilibrium beyond {load:.4f} of the load: Newton's method fails even with "
                f"steps of {2 * step:.1e} of it"
            )
    return Outcome(steps, iterations, residual, correction)


def _settle(problem, load, scale, tolerance):
    """As equilibrate(), until the multipliers of contact change no more."""
    iterations = 0
    for _ in range(MAX_AUGMENTATIONS):
        converged, count, residual, correction = equilibrate(problem, load, scale, tolerance)
        iterations += count
        if not converged:
            break
        change = problem.augment() / (scale or np.abs(problem.displacement.x.array).max() or 1.0)
        if change < tolerance:
            return converged, iterations, residual, correction
    return False, iterations, residual, correction


def equilibrate(problem, load, scale, tolerance):
    """Newton's method at one load, or time: (converged, iterations, residual, correction).

    residual, correction: as of an Outcome. The displacement and pressure of problem are the guess.
    """
    u = problem.displacement.x.array
    fixed = problem.values_at(load)
    problem.load = load
    correction = np.inf
    for count in range(1, MAX_ITERATIONS + 1):
        tangent, residual, recover = problem.linearize()
        if not np.isfinite(residual).all():  # the guess inverts elements
            return False, count, np.nan, correction
        du = np.zeros_like(u)
        # The first correction moves the boundary and the interior together: moving
        # the boundary alone would crush the elements next to it.
        du[problem.fixed] = fixed - u[problem.fixed]
        right = -(residual + tangent @ du)[problem.free]
        free_tangent = tangent[problem.free][:, problem.free]
        del tangent  # the factors need the memory
        du[problem.free] = _direct_solve(free_tangent, right, problem.symmetric)
        dp = recover(du)
        fraction = _advance(problem, du, dp, fixed)
        correction = np.abs(du).max() / (scale or np.abs(u).max() or 1.0)
        if not fraction or correction > LARGEST_CORRECTION:
            return False, count, np.nan, correction
        if correction < tolerance and fraction == 1:
            forces, _ = problem.mixed_residual()
            unbalanced, reactions = (forces[dofs] for dofs in (problem.free, problem.fixed))
            relative = np.linalg.norm(unbalanced) / (np.linalg.norm(reactions) or 1.0)
            return True, count, relative, correction
    return False, count, np.nan, correction


def _advance(problem, du, dp, fixed):
    """Add the largest of du, du/2, du/4, ... that inverts no element, and the same fraction of dp.

    fixed: values of the prescribed dofs after the full du. The energy of an inverted element is
    NaN (J^(-2/3)). Returns the fraction, or 0 if even SMALLEST_FRACTION of the correction inverts
    elements.
    """
    u, p = problem.displacement.x.array, problem.pressure.x.array
    old_u, old_p = u.copy(), p.copy()
    fraction = 1.0
    while fraction >= SMALLEST_FRACTION:
        u[:], p[:] = old_u + fraction * du, old_p + fraction * dp
        forces, _ = problem.mixed_residual()
        if np.isfinite(forces).all():
            if fraction == 1:
                u[problem.fixed] = fixed  # exactly, not old_u + (fixed - old_u)
            return fraction
        fraction /= 2
    return 0.0


def _direct_solve(matrix, right, symmetric):
    """Solve a sparse system with MUMPS, L D L^T or L U: matrix (n, n), right (n,)."""
    matrix.sort_indices()
    size = matrix.shape
    a = PETSc.Mat().createAIJ(size, csr=(matrix.indptr, matrix.indices, matrix.data))
    a.setOption(PETSc.Mat.Option.SYMMETRIC, symmetric)
    ksp = PETSc.KSP().create(PETSc.COMM_SELF)
    ksp.setOperators(a)
    ksp.setType(PETSc.KSP.Type.PREONLY)
    pc = ksp.getPC()
    pc.setType(PETSc.PC.Type.CHOLESKY if symmetric else PETSc.PC.Type.LU)
    pc.setFactorSolverType(PETSc.Mat.SolverType.MUMPS)
    pc.setFactorSetUpSolverType()
    # Indefinite systems delay pivots: half as much memory again as MUMPS expects (default: 20 %).
    pc.getFactorMatrix().setMumpsIcntl(14, 50)
    b = PETSc.Vec().createWithArray(right, comm=PETSc.COMM_SELF)
    x = PETSc.Vec().createWithArray(np.empty(size[0]), comm=PETSc.COMM_SELF)
    ksp.solve(b, x)
    failed = ksp.getConvergedReason() < 0
    solution = np.full(size[0], np.nan) if failed else x.array.copy()
    # petsc4py defers the clean-up of objects that go out of scope: without these calls the factors
    # of all iterations pile up.
    for thing in (pc, ksp, a, b, x):
        thing.destroy()
    return solution


def _report(load, converged, count, residual, correction, seconds):
    """One line of progress on stderr."""
    verdict = f"residual {residual:.1e}" if converged else "failed, step halved"
    print(
        f"load {load:6.4f}: {count} iterations, correction {correction:.1e}, {verdict}, "
        f"{seconds:.3f} s",
        file=sys.stderr,
        flush=True,
    )
