"""The input deck (.inp) of a case for CalculiX (ccx), with its eight-node bricks.

A quasi-static case is *STATIC with NLGEOM: Newton's method and a sparse direct solver. A dynamic
one is *DYNAMIC, EXPLICIT: lumped masses and central differences. The polynomial energy
C10 (I1bar - 3) + C01 (I2bar - 3) + (J - 1)^2 / D1 is the project's with D1 = 2 / K.
"""

import numpy as np

from exchange.abaqus_writer import mesh_lines, number
from exchange.decks.problem import refuse

NAME, ENDING = "CalculiX", ".inp"
ELEMENTS = ("C3D8", "C3D8R", "C3D8I")
VOLUMES = ("quadratic",)
TAKES_HOURGLASS = False

# ccx adapts the increments itself, so this affects only the speed: of 0.1, 0.25 and 1, this value
# needs the fewest iterations on ellipsoid-indentation.
FIRST_INCREMENT = 0.25
MOST_INCREMENTS = 10000
# ccx considers C3D8I stable at a third of the other elements' step; a run that needs still shorter
# steps has diverged.
SHORTER = 10
# Relative, for force residual and displacement correction: the same at which Sandglass stops.
TOLERANCE = 1e-8


def _neo_hookean(material):
    return "NEO HOOKE", [material.shear_modulus / 2]


def _mooney_rivlin(material):
    return "MOONEY-RIVLIN", [material.parameters["c10"], material.parameters["c01"]]


# Law -> (option of *HYPERELASTIC, its constants before D1) of a Material.
LAWS = {"neo-hookean": _neo_hookean, "mooney-rivlin": _mooney_rivlin}


def deck(problem, element, _):
    """{ending: text} of a Problem; node and element i becomes i + 1, as ccx counts from one."""
    motion = problem.motion
    if motion and motion.damping:
        refuse(problem, NAME, "its explicit motions here have no damping")
    lines = ["*HEADING", problem.title]
    lines += mesh_lines(problem.mesh, element, "ALL")
    for i, material in enumerate(problem.materials, 1):
        lines += _material(i, material, len(problem.materials))
    lines += _amplitude(motion) if motion else []
    increments = SHORTER * motion.steps if motion else MOST_INCREMENTS
    lines.append(f"*STEP, NLGEOM, INC={increments}")
    lines += _explicit(motion) if motion else _static()
    ramp = ", AMPLITUDE=RAMP" if motion else ""
    lines.append("*BOUNDARY" + ramp)
    for node, axis in np.argwhere(problem.prescribed):
        value = number(problem.values[node, axis])
        lines.append(f"{node + 1}, {axis + 1}, {axis + 1}, {value}")
    if np.any(problem.forces):
        lines.append("*CLOAD" + ramp)
        for node, axis in np.argwhere(problem.forces):
            lines.append(f"{node + 1}, {axis + 1}, {number(problem.forces[node, axis])}")
    # Writes only the last increment, which ccx always does.
    lines += [f"*NODE FILE, FREQUENCY={increments}", "U", "*END STEP"]
    return {ENDING: "\n".join(lines) + "\n"}


def _material(i, material, count):
    """Material number i of `count`, and the elements that it fills."""
    kind, constants = LAWS[material.law](material)
    elements = "ALL" if count == 1 else f"MADE_OF_{i}"
    lines = []
    if count > 1:
        ids = (material.elements + 1).tolist()
        lines.append(f"*ELSET, ELSET={elements}")
        lines += [", ".join(map(str, ids[k : k + 16])) for k in range(0, len(ids), 16)]
    return lines + [
        f"*MATERIAL, NAME=SOLID{i}",
        f"*HYPERELASTIC, {kind}",
        ", ".join(map(number, [*constants, 2 / material.bulk_modulus])),
        "*DENSITY",
        number(material.density),
        f"*SOLID SECTION, ELSET={elements}, MATERIAL=SOLID{i}",
    ]


def _static():
    """The procedure for a static answer."""
    # The numbers of *CONTROLS are the largest relative residual and correction.
    return [
        "*STATIC",
        f"{FIRST_INCREMENT:g}, 1",
        "*CONTROLS, PARAMETERS=FIELD",
        f"{TOLERANCE:g}, {TOLERANCE:g}",
    ]


def _explicit(motion):
    """The procedure for a motion. The largest increment is the step, which ccx takes if it
    estimates it to be stable. DIRECT is not used, as ccx 2.20 does not return with it."""
    step = motion.time_step
    # ALPHA is numerical damping, which central differences do not have.
    times = ", ".join(map(number, [step, motion.duration, 1e-6 * step, step]))
    return ["*DYNAMIC, EXPLICIT, ALPHA=0.", times]


def _amplitude(motion):
    """The loading curve, tabulated at every step."""
    points = zip(*motion.curve(motion.ramp_steps + 1))
    return ["*AMPLITUDE, NAME=RAMP", *(f"{number(s)}, {number(d)}" for s, d in points)]
