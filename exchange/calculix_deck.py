"""The input deck of a case for CalculiX (ccx).

ccx solves the same problem with its own eight-node bricks: *STATIC with NLGEOM, Newton's method and
a sparse direct solver. Its neo-Hookean energy C10 (J^(-2/3) I1 - 3) + (J - 1)^2 / D1 is that of the
project, mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2, with C10 = mu / 2 and D1 = 2 / K.
Or it moves through time: *DYNAMIC, EXPLICIT, which lumps masses and takes central differences.
"""

from dataclasses import dataclass

import numpy as np

from common.errors import InputError, suggestion
from exchange.abaqus_file import mesh_lines, number

# ccx cuts and stretches the increments by itself, so this only sets the speed: of 0.1, 0.25 and 1
# it needs the fewest iterations on ellipsoid-indentation.
FIRST_INCREMENT = 0.25
MOST_INCREMENTS = 10000
# ccx takes C3D8I for stable at a third of the step of the others; what needs far more is lost.
SHORTER = 10
# Of force residual and displacement correction, relative: that at which Sandglass rests.
TOLERANCE = 1e-8


@dataclass(frozen=True)
class Explicit:
    """A motion by central differences: steps of time_step (s), with density in kg/m^3.

    What is imposed rises by the project's loading curve (eq. 15 of the paper) over the first
    ramp_steps, and stays.
    """

    density: float
    time_step: float
    steps: int
    ramp_steps: int

    def lines(self):
        """The procedure. Largest increment: the step, which ccx takes where it is stable by its own
        estimate. Not DIRECT: with it ccx 2.20 does not come back."""
        times = [self.time_step, self.time_step * self.steps, 1e-6 * self.time_step, self.time_step]
        # ALPHA is numerical damping, for which central differences have no place.
        return ["*DYNAMIC, EXPLICIT, ALPHA=0.", ", ".join(map(number, times))]

    def amplitude(self):
        """The loading curve, told at every step."""
        parts = np.arange(self.ramp_steps + 1) / self.ramp_steps
        curve = (10 - 15 * parts + 6 * parts**2) * parts**3
        points = zip(self.time_step * np.arange(self.ramp_steps + 1), curve)
        return ["*AMPLITUDE, NAME=RAMP", *(f"{number(s)}, {number(d)}" for s, d in points)]


def neo_hookean(material):
    """The lines of *HYPERELASTIC for the project's neo-Hookean law. material: dict, SI units."""
    young, poisson = material["young_modulus"], material["poisson_ratio"]
    mu, bulk = young / 2 / (1 + poisson), young / 3 / (1 - 2 * poisson)
    return ["*HYPERELASTIC, NEO HOOKE", f"{number(mu / 2)}, {number(2 / bulk)}"]


# Laws that ccx has, by the project's name.
LAWS = {"neo-hookean": neo_hookean}


def deck(title, mesh, law, material, prescribed, values, **options):
    """The input deck of a case, as text.

    title: one line. mesh: with points, cells and sets, as HexMesh; node and element i becomes
    i + 1, as ccx counts from one. law: name out of LAWS. material: dict of its numbers (SI).
    prescribed: (n, 3) bool, the displacements that values (n, 3), m, impose. Options:
    forces: (n, 3), N, or None. element: ccx's name of an eight-node brick, C3D8 unless said.
    tolerance: of force residual and displacement correction; None takes ccx's own (0.005 and 0.01).
    explicit: an Explicit, or None for *STATIC. Raises InputError for a law that ccx lacks.
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
    # Of all increments only the last is written, which ccx always does.
    lines += [f"*NODE FILE, FREQUENCY={increments}", "U", "*END STEP"]
    return "\n".join(lines) + "\n"


def _static(tolerance):
    """The procedure of an answer at rest. tolerance: as deck takes it."""
    lines = ["*STATIC", f"{FIRST_INCREMENT:g}, 1"]
    if tolerance is not None:
        # The first two numbers: largest residual and largest correction, relative.
        lines += ["*CONTROLS, PARAMETERS=FIELD", f"{tolerance:g}, {tolerance:g}"]
    return lines
