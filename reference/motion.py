"""Goldens of motion: the golden's element, integrated in time by an implicit scheme.

Space is discretised as in the solver, with its lumped masses and its damping, so that
tl-mean-dilatation and a golden of motion differ only in the integration in time.
"""

import sys
from dataclasses import dataclass

import numpy as np
import scipy.sparse

import newton
from common.accuracy import relative_errors
from common.errors import ComputationError
from problem import MixedProblem

# Newton's method converges quadratically: its last correction is below the square of this.
TOLERANCE = 1e-6

# Steps of a frame in the first run.
FIRST_STEPS = 4

# Steps are halved until this changes the extrapolated motion by less than this share of the unit.
HALVING_LIMIT = 1e-4
MOST_HALVINGS = 8


class MovingProblem(MixedProblem):
    """A MixedProblem in motion, M a + c M v + f(u, p) = loads, over one step of the trapezoidal
    rule (Newmark's with constant average acceleration) at a time.

    mesh, materials: as of a MixedProblem. motion: Motion. velocity: (n, 3) m/s, at the start.
    `load` is the time (s) that imposed displacements and loads follow.
    """

    def __init__(self, mesh, materials, motion, velocity):
        super().__init__(mesh, materials)
        self._motion = motion
        self._masses = self.loads.masses
        self._v = self.dofs_of(velocity)
        self._v[self.fixed] = 0.0  # imposed components have no inertia
        self._start = np.zeros_like(self._v)  # displacement at the start of the step
        self._step = np.inf
        self.load = 0.0
        forces, _ = super().mixed_residual()
        self._a = -forces / self._masses - motion.damping * self._v

    def values_at(self, load):
        """Values (in m) of the prescribed dofs at a time."""
        return super().values_at(self._motion.load_factor(load))

    def factor_of(self, curve):
        """The factor of a load at the current time."""
        if curve is None:
            return self._motion.load_factor(self.load)
        return curve(self.load)

    def linearize(self):
        """As of a MixedProblem, with inertia and damping."""
        tangent, residual, recover = super().linearize()
        c, h = self._motion.damping, self._step
        inertia = scipy.sparse.diags(self._masses * (4 / h**2 + 2 * c / h))
        return (tangent + inertia).tocsr(), residual, recover  # of mixed_residual() below

    def mixed_residual(self):
        """As of a MixedProblem, with inertia and damping."""
        forces, dilatation = super().mixed_residual()
        return forces + self._inertia(), dilatation

    def advance(self, time, unit):
        """Takes the step to a time (s). unit: of displacements, m, for the last correction.

        Returns Newton's (iterations, residual, correction), as of an Outcome. Raises
        ComputationError if it does not converge.
        """
        u = self.displacement.x.array
        self._start = u.copy()
        self._step = time - self.load
        u += self._step * self._v + 0.5 * self._step**2 * self._a
        u[self.fixed] = self._start[self.fixed]
        converged, *course = newton.equilibrate(self, time, unit, TOLERANCE)
        if not converged:
            raise ComputationError(
                f"no motion beyond {time:.6g} s with steps of {self._step:.3g} s"
            )
        self._v, self._a = self._rates()
        self._v[self.fixed] = self._a[self.fixed] = 0.0
        return course

    def _rates(self):
        """Velocity and acceleration (N,) at the end of the step, by the trapezoidal rule."""
        moved, h = self.displacement.x.array - self._start, self._step
        return 2 / h * moved - self._v, 4 / h**2 * (moved - h * self._v) - self._a

    def _inertia(self):
        """Forces (N,) in N of inertia and damping at the end of the step."""
        v, a = self._rates()
        return self._masses * (a + self._motion.damping * v)


@dataclass(frozen=True)
class Golden:
    """A golden of motion: displacements (frames, n, 3) in m, and how they were found.

    unit: of errors, m. halving: (max, rms), the largest over all frames of what halving the steps
    last changed, over the unit. outcome: Outcome of the finest run, of its worst step.
    """

    displacement: np.ndarray
    unit: float
    halving: tuple
    outcome: newton.Outcome


def integrate(mesh, materials, motion, velocity, steps):
    """Displacements (frames, n, 3) in m with `steps` equal steps in each frame, and an Outcome.

    Arguments as of a MovingProblem. Raises ComputationError.
    """
    problem = MovingProblem(mesh, materials, motion, velocity)
    frames, courses, unit = [], [], problem.scale
    for n, end in enumerate(motion.times()):
        for k in range(1, steps + 1):
            time = end if k == steps else motion.duration / motion.frames * (n + k / steps)
            courses.append(problem.advance(time, unit))
            unit = max(unit, np.abs(problem.displacement.x.array).max())
        frames.append(problem.nodal_displacement())
    iterations, residuals, corrections = zip(*courses)
    outcome = newton.Outcome(len(courses), sum(iterations), max(residuals), max(corrections))
    return np.array(frames), outcome


def solve_motion(mesh, materials, motion, velocity):
    """The Golden of a motion: steps are halved until the change is below HALVING_LIMIT.

    The error of the trapezoidal rule has only even powers of the step, so two runs give an
    extrapolated motion of fourth order (Richardson). Arguments as of a MovingProblem. Raises
    ComputationError.
    """
    coarse = extrapolated = None
    for halvings in range(MOST_HALVINGS + 1):
        steps = FIRST_STEPS * 2**halvings
        fine, outcome = integrate(mesh, materials, motion, velocity, steps)
        before = extrapolated
        extrapolated = None if coarse is None else fine + (fine - coarse) / 3
        coarse = fine
        if before is None:
            continue
        unit = mesh.largest_imposed() or np.linalg.norm(extrapolated, axis=2).max()
        errors = [relative_errors(*pair, unit) for pair in zip(before, extrapolated)]
        halving = tuple(np.max(errors, axis=0))
        print(f"{motion.frames * steps} steps: {halving[0]:.1e}", file=sys.stderr, flush=True)
        if halving[0] < HALVING_LIMIT:
            return Golden(extrapolated, unit, halving, outcome)
    raise ComputationError(f"halving the steps still changes {halving[0]:.1e} of the motion")
