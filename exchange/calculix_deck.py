"""The input deck of a case for CalculiX (ccx).

ccx solves the same problem with its own eight-node bricks: *STATIC with NLGEOM, Newton's method and
a sparse direct solver. Its neo-Hookean energy C10 (J^(-2/3) I1 - 3) + (J - 1)^2 / D1 is that of the
project, mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2, with C10 = mu / 2 and D1 = 2 / K.
Alternatively it integrates in time: *DYNAMIC, EXPLICIT uses lumped masses and central differences.
"""

from dataclasses import dataclass

import numpy as np

from common.errors import InputError, suggestion
from exchange.abaqus_file import mesh_lines, number

# ccx adapts the increments itself, so this affects only the speed: of 0.1, 0.25 and 1, this value
# needs the fewest iterations on ellipsoid-indentation.
FIRST_INCREMENT = 0.25
MOST_INCREMENTS = 10000
# ccx considers C3D8I stable at a third of the other elements' step; a run that needs still shorter
# steps has diverged.
SHORTER = 10
# Relative, for force residual and displacement correction: the same at which Sandglass stops.
TOLERANCE = 1e-8


@dataclass(frozen=True)
class Explicit:
    """A motion by central differences: steps of time_step (s), with density in kg/m^3.

    Imposed values follow the project's loading curve (eq. 15 of the paper) over the first
    ramp_steps and are then held.
    """

    density: float
    time_step: float
    steps: int
    ramp_steps: int

    def lines(self):
        """The procedure. The largest increment is the step, which ccx takes if its own estimate
        says it is stable. Not DIRECT: with it ccx 2.20 does not return."""
        times = [self.time_step, self.time_step * self.steps, 1e-6 * self.time_step, self.time_step]
        # ALPHA is numerical damping, which central differences do not have.
        return ["*DYNAMIC, EXPLICIT, ALPHA=0.", ", ".join(map(number, times))]

    def amplitude(self):
        """The loading curve, given at every step."""
        parts = np.arange(self.ramp_steps + 1) / self.ramp_steps
        curve = (10 - 15 * parts + 6 * parts**2) * parts**3
        points = zip(self.time_step * np.arange(self.ramp_steps + 1), curve)
        return ["*AMPLITUDE, NAME=RAMP", *(f"{number(s)}, {number(d)}" for s, d in points)]


def neo_hookean(material):
    """The lines of *HYPERELASTIC for the project's neo-Hookean law. material: dict, SI units."""
    young, poisson = material["young_modulus"], material["poisson_ratio"]
    mu, bulk = young / 2 / (1 + poisson), young / 3 / (1 - 2 * poisson)
    return ["*HYPERELASTIC, NEO HOOKE", f"{number(mu / 2)}, {number(2 / bulk)}"]


# Laws supported by ccx, by the project's name.
LAWS = {"neo-hookean": neo_hookean}


def deck(title, mesh, law, material, prescribed, values, **options):
    """The input deck of a case, as text.

    title: one line. mesh: has points, cells and sets, like HexMesh; node and element i becomes
    i + 1, as ccx counts from one. law: a name in LAWS. material: dict of its parameters (SI).
    prescribed: (n, 3) bool, which displacements are imposed. values: (n, 3), m. Options:
    forces: (n, 3), N, or None. element: ccx's name of an eight-node brick, default C3D8.
    tolerance: of force residual and displacement correction; None means ccx's default (0.005 and
    0.01). explicit: an Explicit, or None for *STATIC. Raises InputError for a law that ccx lacks.
    """
    if law not in LAWS:
        raise InputError(
            f"material.law = {law!r} is not known to CalculiX; {suggestion(law, sorted(LAWS))}"
        )
    forces, explicit = options.get("forces"), options.get("explicit")
    lines = ["*HEADING", " ".join(title.split())]
    lines += mesh_lines(mesh, options.get("element", "C3D8"), "ALL")
    lines += ["*MATERIAL, NAME=SOLID", *LAWS[law](material)]
    lines += ["*DENSITY", number(explicit.density)] if explicit else []
    lines += ["*SOLID SECTION, ELSET=ALL, MATERIAL=SOLID"]
    lines += explicit.amplitude() if explicit else []
    increments = SHORTER * explicit.steps if explicit else MOST_INCREMENTS
    lines.append(f"*STEP, NLGEOM, INC={increments}")
    lines += explicit.lines() if explicit else _static(options.get("tolerance", TOLERANCE))
    ramp = ", AMPLITUDE=RAMP" if explicit else ""
    lines.append("*BOUNDARY" + ramp)
    for node, axis in np.argwhere(prescribed):
        lines.append(f"{node + 1}, {axis + 1}, {axis + 1}, {number(values[node, axis])}")
    if forces is not None and np.any(forces):
        lines.append("*CLOAD" + ramp)
        for node, axis in np.argwhere(forces):
            lines.append(f"{node + 1}, {axis + 1}, {number(forces[node, axis])}")
    # Writes only the last increment, which ccx always does.
    lines += [f"*NODE FILE, FREQUENCY={increments}", "U", "*END STEP"]
    return "\n".join(lines) + "\n"


def _static(tolerance):
    """The procedure for a static answer. tolerance: as for deck()."""
    lines = ["*STATIC", f"{FIRST_INCREMENT:g}, 1"]
    if tolerance is not None:
        # The first two numbers are the largest relative residual and correction.
        lines += ["*CONTROLS, PARAMETERS=FIELD", f"{tolerance:g}, {tolerance:g}"]
    return lines
