"""The problem of a deck: mesh, materials, supports, loads, and the motion if there is one."""

import math
from dataclasses import dataclass, field

import numpy as np

from common.errors import InputError
from exchange.foreign_mesh import HexMesh

# A quasi-static case for a program that only integrates in time. The unit of time is the time in
# which a shear wave crosses the body: slow enough for the lowest modes of the canonical cases,
# which the damping suppresses.
RELAXATION_CROSSINGS = 20
DAMPING_PER_CROSSING = 2.0
STEP_FRACTION = 0.8  # of the stable step of Sandglass
# Points of the loading curve; other programs interpolate linearly between them, to 2e-5.
CURVE_POINTS = 201


@dataclass(frozen=True)
class Material:
    """A law by the project's name, its parameters (SI) and its density (kg/m^3).

    shear_modulus, bulk_modulus: undeformed, Pa. volumetric: the name of the volumetric energy.
    elements: rows of the elements made of it.
    """

    law: str
    parameters: dict
    density: float
    shear_modulus: float
    bulk_modulus: float
    volumetric: str
    elements: np.ndarray


@dataclass(frozen=True)
class Motion:
    """Central differences: steps of time_step (s), mass-proportional damping (1/s).

    Imposed values follow the project's loading curve (eq. 15 of the paper) over the first
    ramp_steps and are then held.
    """

    time_step: float
    steps: int
    ramp_steps: int
    damping: float = 0.0

    @property
    def duration(self):
        """Simulated time, s."""
        return self.steps * self.time_step

    def curve(self, points=CURVE_POINTS):
        """Times (s) and factors of the loading curve, at equal distances over the ramp.

        The factors are the nearest doubles: whole numbers of any size, divided once.
        """
        n = points - 1
        factors = [(10 * n**2 - 15 * k * n + 6 * k**2) * k**3 / n**5 for k in range(points)]
        return np.arange(points) * (self.ramp_steps * self.time_step) / n, np.array(factors)


@dataclass(frozen=True)
class Problem:
    """A case as a deck needs it.

    title: one line. mesh: HexMesh. materials: list of Material. prescribed: (n, 3) bool, which
    displacements are imposed. values: (n, 3), m. forces: (n, 3), N. motion: a Motion, or None for a
    quasi-static case. stable_step: of Sandglass, s. name: of the deck's files, without ending.
    obstacles, pairs: lists of Obstacle and Pair. ties: {node: [(other, weight)]} of hanging nodes,
    which are where the weighted mean of others is.
    """

    title: str
    mesh: HexMesh
    materials: list
    prescribed: np.ndarray
    values: np.ndarray
    forces: np.ndarray
    motion: Motion | None
    stable_step: float
    name: str = ""
    obstacles: tuple = ()
    pairs: tuple = ()
    ties: dict = field(default_factory=dict)

    def relaxation(self):
        """A damped motion that ends at the quasi-static answer."""
        size = np.linalg.norm(np.ptp(self.mesh.points, axis=0))
        speed = min(math.sqrt(m.shear_modulus / m.density) for m in self.materials)
        crossing, step = size / speed, STEP_FRACTION * self.stable_step
        steps = math.ceil(RELAXATION_CROSSINGS * crossing / step)
        return Motion(step, steps, steps, agreed(DAMPING_PER_CROSSING / crossing))

    def imposed(self):
        """(component, value in m, nodes) of imposed displacements, grouped by value."""
        return _alike(self.prescribed, self.values)

    def applied(self):
        """(component, force in N, nodes) of all nodal forces, grouped by value."""
        return _alike(self.forces, self.forces)


def agreed(value):
    """A number with twelve digits, so that all processors write the same deck.

    Sums, products, quotients and square roots are the same on all of them. Powers, exponentials and
    results of BLAS or LAPACK differ in the last of sixteen digits.
    """
    return float(f"{value:.12g}")


def _alike(given, values):
    """(component, value, nodes) of the components (n, 3) that are given, by component and value."""
    found = []
    for component in range(3):
        nodes = np.flatnonzero(given[:, component])
        distinct, group = np.unique(values[nodes, component], return_inverse=True)
        found += [(component, v, nodes[group == i]) for i, v in enumerate(distinct)]
    return found


def refuse(problem, program, reason):
    """Raises InputError: a program cannot express the problem."""
    raise InputError(f"{problem.title}: {program} cannot express it: {reason}")
