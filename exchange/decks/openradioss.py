"""The starter and engine files (_0000.rad, _0001.rad) of a case for OpenRadioss.

Law 42, sum mu_p / alpha_p (lbar_1^alpha_p + ... - 3) + K/2 (J - 1)^2, covers the project's
laws. It integrates in time: a quasi-static case becomes a damped motion.
"""

import numpy as np

from exchange.abaqus_writer import number
from exchange.decks.contact import AT_REST, Expressible

NAME, ENDING = "OpenRadioss", "_0000.rad"
# Isolid, Icpre: physical stabilisation, viscous hourglass control, and eight points with a constant
# pressure.
ELEMENTS = {"HEPH": (24, 0), "viscous": (1, 0), "H8C": (17, 1)}
VOLUMES = ("quadratic",)
TAKES_HOURGLASS = True  # h of the viscous control
TAKES_HANGING_NODES = False
WALLS = {"plane": "PLANE", "sphere": "SPHER", "cylinder": "CYL"}
CONTACT = Expressible(
    shapes=tuple(WALLS),
    obstacles=(AT_REST, "kinematic"),
    pairs=(AT_REST, "penalty"),
    itself=(AT_REST, "penalty"),
    how="/RWALL; /INTER/TYPE24 with its own stiffness",
)
WALL_MASS = 1.0  # kg; walls are driven, so that any will do
USUAL_HOURGLASS = 0.1
NO_VISCOSITY = 1e-20  # zero would mean the default
# The engine takes the smaller of its own step, times this, and the largest step of /DTIX.
STEP_SCALE = 0.9
PER_LINE = 10  # numbers of nodes
DOFS = "XYZ"

# Law -> [(mu_p, alpha_p)] of a Material.
LAWS = {
    "neo-hookean": lambda m: [(m.shear_modulus, 2.0)],
    "mooney-rivlin": lambda m: [(2 * m.parameters["c10"], 2.0), (-2 * m.parameters["c01"], -2.0)],
    "ogden": lambda m: [
        (2 * m.parameters[f"mu{p}"] / m.parameters[f"alpha{p}"], m.parameters[f"alpha{p}"])
        for p in (1, 2)
        if m.parameters.get(f"mu{p}")
    ],
}


def deck(problem, element, hourglass):
    """{ending: text} of a Problem. hourglass: h, or None for its usual value."""
    motion = problem.motion or problem.relaxation()
    lines = ["#RADIOSS STARTER", "/BEGIN", problem.name, f"{2024:10d}{0:10d}"]
    lines += ["".join(f"{unit:>20}" for unit in ("kg", "m", "s"))] * 2
    lines += ["/TITLE", problem.title[:100]]
    for i, material in enumerate(problem.materials, 1):
        lines += _material(i, material) + _property(i, element, hourglass)
        lines += [f"/PART/{i}", f"part {i}", f"{i:10d}{i:10d}"]
    lines.append("/NODE")
    # The last nodes carry walls.
    points = np.vstack([problem.mesh.points, *(wall.point for wall in problem.obstacles)])
    lines += [f"{n:10d}{_reals(point)}" for n, point in enumerate(points, 1)]
    for i, material in enumerate(problem.materials, 1):
        lines.append(f"/BRICK/{i}")
        for e in material.elements:
            lines.append(f"{e + 1:10d}" + _integers(problem.mesh.cells[e] + 1))
    lines += ["/FUNCT/1", "loading curve"]
    lines += [_reals(point) for point in zip(*motion.curve())]
    imposed = problem.imposed() + [
        (axis, value, np.array([node]))
        for node, wall in enumerate(problem.obstacles, len(problem.mesh.points))
        for axis, value in enumerate(wall.displacement)
    ]
    applied = problem.applied()
    lines += _conditions(imposed, applied) + _walls(problem, 2 + len(imposed) + len(applied))
    lines += _interfaces(problem.pairs)
    if motion.damping:
        lines += ["/GRNOD/PART/1", "all", _integers(range(1, len(problem.materials) + 1))]
        lines += ["/DAMP/1", "mass-proportional", _reals([motion.damping, 0.0]) + f"{1:10d}"]
    lines.append("/END")
    return {ENDING: "\n".join(lines) + "\n", "_0001.rad": _engine(problem.name, motion)}


def _material(i, material):
    """The lines of material i."""
    terms = LAWS[material.law](material)
    shear, bulk = sum(mu * alpha for mu, alpha in terms) / 2, material.bulk_modulus
    poisson = (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear)
    spare = [(0.0, 0.0)] * (5 - len(terms))
    mus, alphas = zip(*terms, *spare)
    return [
        f"/MAT/LAW42/{i}",
        f"material {i}",
        _reals([material.density]),
        _reals([poisson, 0.0]) + f"{0:10d}{0:10d}" + _reals([0.0]),
        _reals(mus),
        "",
        _reals(alphas),
        "",
    ]


def _property(i, element, hourglass):
    """The lines of property i: total strain from the undeformed state, no bulk viscosity."""
    solid, pressure = ELEMENTS[element]
    control = USUAL_HOURGLASS if hourglass is None else hourglass
    return [
        f"/PROP/TYPE14/{i}",
        f"property {i}",
        _integers([solid, 10, 0, pressure, 0, 222 if solid == 17 else 0, 0, 0]) + _reals([0.0]),
        _reals([NO_VISCOSITY, NO_VISCOSITY, control, 0.0, 0.0]),
        _reals([0.0] * 5),
        _integers([0, 0, 0]),
    ]


def _group(i, nodes):
    """The lines of node group i."""
    rows = (_integers(nodes[k : k + PER_LINE] + 1) for k in range(0, len(nodes), PER_LINE))
    return [f"/GRNOD/NODE/{i}", f"nodes {i}", *rows]


def _walls(problem, group):
    """The lines of obstacles as rigid walls that a node carries, each with its node group, from
    number `group` on. Nodes that are wholly imposed are left out: they feel no obstacle."""
    lines, free = [], ~problem.prescribed.all(axis=1)
    for i, wall in enumerate(problem.obstacles, 1):
        nodes = np.unique(wall.faces)
        lines += _group(group, nodes[free[nodes]])
        node, slide = len(problem.mesh.points) + i, 2 if wall.friction else 0
        lines += [f"/RWALL/{WALLS[wall.shape]}/{i}", wall.words[:100]]
        lines.append(_integers([node, slide, group, 0]))
        lines.append(_reals([0.0, wall.friction, 2 * wall.radius]))
        lines.append(_reals([WALL_MASS, 0.0, 0.0, 0.0]))
        if wall.shape == "plane":
            lines.append(_reals(wall.point + wall.normal / np.linalg.norm(wall.normal)))
        elif wall.shape == "cylinder":
            lines.append(_reals(wall.end))
        group += 1
    return lines


def _interfaces(pairs):
    """The lines of pairs of surfaces, or of one with itself."""
    lines, surface = [], 0
    for i, pair in enumerate(pairs, 1):
        numbers = []
        for faces in (pair.faces, pair.other_faces):
            if faces is None:
                numbers.append(0)
                continue
            surface += 1
            numbers.append(surface)
            lines += [f"/SURF/SEG/{surface}", f"surface {surface}"]
            lines += [_integers([k, *face]) for k, face in enumerate(faces + 1, 1)]
        lines += [f"/INTER/TYPE24/{i}", pair.words[:100]]
        lines.append(_integers(numbers))
        lines += ["", ""]  # gaps, stiffness and penetrations: its own
        lines.append(_reals([0.0, pair.friction]))
        lines += ["", ""]  # no damping of its own, Coulomb's law
    return lines


def _conditions(imposed, applied):
    """The lines of all supports, imposed displacements and forces, each with its node group."""
    lines = []
    for i, (component, value, nodes) in enumerate([*imposed, *applied], 2):
        lines += _group(i, nodes)
        direction = f"{DOFS[component]:>10}"
        if i - 2 >= len(imposed):
            lines += [f"/CLOAD/{i}", f"force {i}"]
            lines.append(f"{1:10d}{direction}{0:10d}{0:10d}{i:10d}{'':10}" + _reals([1.0, value]))
        elif value:
            lines += [f"/IMPDISP/{i}", f"displacement {i}"]
            lines += [f"{1:10d}{direction}{0:10d}{0:10d}{i:10d}", _reals([1.0, value])]
        else:
            held = "".join("1" if axis == component else "0" for axis in range(3))
            lines += [f"/BCS/{i}", f"support {i}", f"   {held} 000{0:10d}{i:10d}"]
    return lines


def _engine(name, motion):
    """The engine file: the motion, and an animation file with the final displacements."""
    end, step = repr(motion.duration), repr(motion.time_step)
    lines = [f"/RUN/{name}/1", end, "/PRINT/-1000", "/TFILE", end, "/DT", f"{STEP_SCALE} 0.0"]
    lines += ["/DTIX", f"{step} {step}", "/ANIM/DT", f"{end} {end}", "/ANIM/VECT/DISP", "/END", ""]
    return "\n".join(lines)


def _reals(values):
    """Numbers in columns of 20 characters."""
    return "".join(f"{number(value):>20}" for value in values)


def _integers(values):
    """Whole numbers in columns of 10 characters."""
    return "".join(f"{value:10d}" for value in values)
