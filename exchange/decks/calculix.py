"""The input deck (.inp) of a case for CalculiX (ccx), with its eight-node bricks.

A quasi-static case is *STATIC with NLGEOM: Newton's method and a sparse direct solver. A dynamic
one is *DYNAMIC, EXPLICIT: lumped masses and central differences. The polynomial energy
C10 (I1bar - 3) + C01 (I2bar - 3) + (J - 1)^2 / D1 is the project's with D1 = 2 / K.
"""

import numpy as np

from exchange.abaqus_writer import mesh_lines, number
from common.hexahedron import FACES
from exchange.decks import rigid_surface
from exchange.decks.contact import AT_REST, SHAPES, Expressible
from exchange.decks.problem import refuse

NAME, ENDING = "CalculiX", ".inp"
ELEMENTS = ("C3D8", "C3D8R", "C3D8I")
VOLUMES = ("quadratic",)
TAKES_HOURGLASS = False
TAKES_HANGING_NODES = True
CONTACT = Expressible(
    shapes=SHAPES,
    inside=True,
    obstacles=(AT_REST,),
    pairs=(AT_REST,),
    how="surface-to-surface pairs; obstacles as rigid surfaces of triangles",
)

# ccx adapts the increments itself, so this affects only the speed: of 0.1, 0.25 and 1, this value
# needs the fewest iterations on ellipsoid-indentation.
FIRST_INCREMENT = 0.25
MOST_INCREMENTS = 10000
# ccx considers C3D8I stable at a third of the other elements' step; a run that needs still shorter
# steps has diverged.
SHORTER = 10
OWN = "DECK_"  # begins the names of the deck's own sets
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
    if any(name.upper().startswith(OWN) for name in problem.mesh.sets):
        refuse(problem, NAME, f"names of sets that begin with {OWN} are the deck's own")
    lines = ["*HEADING", problem.title]
    lines += mesh_lines(problem.mesh, element, "ALL")
    for i, material in enumerate(problem.materials, 1):
        lines += _material(i, material, len(problem.materials))
    rigid = rigid_surface.parts(problem)
    lines += _obstacles(problem, rigid) + _pairs(problem)
    for one, names in _touching(problem):
        lines += _touch(one, *names)
    lines += _equations(problem.ties)
    lines += _amplitude(motion) if motion else []
    increments = SHORTER * motion.steps if motion else MOST_INCREMENTS
    lines.append(f"*STEP, NLGEOM, INC={increments}")
    lines += _explicit(motion) if motion else _static()
    ramp = ", AMPLITUDE=RAMP" if motion else ""
    lines.append("*BOUNDARY" + ramp)
    for node, axis in np.argwhere(problem.prescribed):
        value = number(problem.values[node, axis])
        lines.append(f"{node + 1}, {axis + 1}, {axis + 1}, {value}")
    for i, obstacle in enumerate(problem.obstacles, 1):
        for axis, value in enumerate(obstacle.displacement, 1):
            lines.append(f"{OWN}OBSTACLE{i}, {axis}, {axis}, {number(value)}")
    if np.any(problem.forces):
        lines.append("*CLOAD" + ramp)
        for node, axis in np.argwhere(problem.forces):
            lines.append(f"{node + 1}, {axis + 1}, {number(problem.forces[node, axis])}")
    # Writes only the last increment, which ccx always does.
    body = f"NSET={OWN}BODY, " if rigid else ""
    lines += [f"*NODE FILE, {body}FREQUENCY={increments}", "U"]
    for _, (slave, master) in _touching(problem):
        lines += [f"*CONTACT PRINT, SLAVE={slave}, MASTER={master}, FREQUENCY={increments}", "CF"]
    lines.append("*END STEP")
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


def _obstacles(problem, rigid):
    """The rigid surfaces of obstacles, and the faces that they touch."""
    lines, element = [], len(problem.mesh.cells)
    if rigid:
        lines += [f"*NSET, NSET={OWN}BODY, GENERATE", f"1, {len(problem.mesh.points)}, 1"]
    for i, (obstacle, (nodes, cells)) in enumerate(zip(problem.obstacles, rigid), 1):
        lines.append(f"*NODE, NSET={OWN}OBSTACLE{i}")
        first = cells.min() + 1
        lines += [f"{n}, " + ", ".join(map(number, x)) for n, x in enumerate(nodes, first)]
        lines.append(f"*ELEMENT, TYPE=C3D4, ELSET={OWN}OBSTACLE{i}")
        ids = range(element + 1, element + 1 + len(cells))
        lines += [f"{e}, " + ", ".join(map(str, cell)) for e, cell in zip(ids, cells + 1)]
        element += len(cells)
        lines += [f"*SURFACE, NAME=RIGID{i}, TYPE=ELEMENT", *(f"{e}, S1" for e in ids)]
        lines += _surface(f"TOUCHES{i}", obstacle.faces, problem.mesh.cells)
        # All of its nodes are driven: any stiffness will do.
        lines += [f"*MATERIAL, NAME=RIGID{i}", "*ELASTIC", "1., 0.", "*DENSITY", "1."]
        lines.append(f"*SOLID SECTION, ELSET={OWN}OBSTACLE{i}, MATERIAL=RIGID{i}")
    return lines


def _pairs(problem):
    """The surfaces of pairs."""
    lines = []
    for i, pair in enumerate(problem.pairs, 1):
        lines += _surface(f"FIRST{i}", pair.faces, problem.mesh.cells)
        lines += _surface(f"SECOND{i}", pair.other_faces, problem.mesh.cells)
    return lines


def _touching(problem):
    """Each Obstacle and Pair, and the names of its two surfaces."""
    found = [(one, (f"TOUCHES{i}", f"RIGID{i}")) for i, one in enumerate(problem.obstacles, 1)]
    return found + [(one, (f"FIRST{i}", f"SECOND{i}")) for i, one in enumerate(problem.pairs, 1)]


def _surface(name, faces, cells):
    """A surface of faces (f, 4) of cells (m, 8), whose sides ccx numbers in the order of FACES."""
    sides = np.sort(cells[:, FACES], axis=2).reshape(-1, 4)
    of_side = dict(zip(map(tuple, sides.tolist()), range(len(sides))))
    found = [divmod(of_side[tuple(face)], 6) for face in np.sort(faces, axis=1).tolist()]
    return [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *(f"{e + 1}, S{k + 1}" for e, k in found)]


def _touch(contact, slave, master):
    """An Obstacle or a Pair as two surfaces: pressure in proportion to the depth and, along them, a
    spring of the same stiffness until it slips."""
    lines = [f"*SURFACE INTERACTION, NAME={slave}"]
    lines += ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", number(contact.stiffness)]
    if contact.friction:
        lines += ["*FRICTION", f"{number(contact.friction)}, {number(contact.stiffness)}"]
    lines.append(f"*CONTACT PAIR, INTERACTION={slave}, TYPE=SURFACE TO SURFACE")
    return lines + [f"{slave}, {master}"]


def _equations(ties):
    """Hanging nodes as linear equations, one for each component."""
    lines = []
    for node, shares in ties.items():
        terms = [(node, -1.0), *shares]
        for axis in (1, 2, 3):
            lines += ["*EQUATION", str(len(terms))]
            texts = [f"{n + 1}, {axis}, {number(weight)}" for n, weight in terms]
            lines += [", ".join(texts[k : k + 4]) for k in range(0, len(texts), 4)]
    return lines


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
