"""The model file (.feb, version 4.0) of a case for FEBio.

A quasi-static case is solved by its Newton method, a dynamic one by its explicit solver. Uncoupled
materials with pressure_model "Abaqus" have the project's volumetric energy K/2 (J - 1)^2.
"""

import math

import numpy as np

from common.errors import InputError
from exchange.decks import rigid_surface
from exchange.decks.contact import AT_REST, SHAPES, Expressible
from exchange.decks.problem import refuse, agreed

NAME, ENDING = "FEBio", ".feb"
# The three-field element is the golden's (mean dilatation); the next has one point and hourglass
# control, and the last is the displacement element.
ELEMENTS = ("three-field-solid", "udg-hex", "elastic-solid")
VOLUMES = {"logarithmic": "default", "quadratic-logarithmic": "NIKE3D", "quadratic": "Abaqus"}
TAKES_HOURGLASS = True  # hg of udg-hex
TAKES_HANGING_NODES = False
CONTACT = Expressible(
    shapes=SHAPES,
    inside=True,
    obstacles=(AT_REST, "penalty"),
    pairs=(AT_REST, "penalty"),
    how="sliding-elastic; obstacles as rigid bodies of triangles",
)
DOFS = "xyz"
LOAD_STEPS = 10
# Norms of displacement, residual and energy at which Newton's method stops.
TOLERANCE = 1e-9


def _mooney_rivlin(c1, c2):
    return "Mooney-Rivlin", {"c1": c1, "c2": c2}


def _ogden(*, mu1, alpha1, mu2=0.0, alpha2=2.0, bulk_modulus):
    """FEBio divides c by m^2 where Sandglass has 2 mu / alpha^2."""
    if 0 in (alpha1, alpha2):
        raise InputError("material: an Ogden exponent of 0 is not known to FEBio")
    return "Ogden", {"c1": 2 * mu1, "m1": alpha1, "c2": 2 * mu2, "m2": alpha2}


def _yeoh(*, c1, c2, c3, bulk_modulus):
    """FEBio's stress, unlike its energy, is that of sum c_i / i (I1bar - 3)^i (FEYeoh.cpp)."""
    return "Yeoh", {"c1": c1, "c2": 2 * c2, "c3": 3 * c3}


# Law -> (FEBio's type, its parameters) of a Material.
LAWS = {
    "neo-hookean": lambda m: _mooney_rivlin(m.shear_modulus / 2, 0.0),
    "mooney-rivlin": lambda m: _mooney_rivlin(m.parameters["c10"], m.parameters["c01"]),
    "yeoh": lambda m: _yeoh(**m.parameters),
    "ogden": lambda m: _ogden(**m.parameters),
}


def deck(problem, element, hourglass):
    """{ending: text} of a Problem. hourglass: hg of udg-hex, or None for its usual value."""
    if hourglass is not None and element != "udg-hex":
        refuse(problem, NAME, f"{element} has no hourglass control; udg-hex has")
    mesh, motion = problem.mesh, problem.motion
    lines = ["<?xml version='1.0' encoding='UTF-8'?>", f"<!-- {problem.title} -->"]
    lines += ['<febio_spec version="4.0">', '<Module type="solid"/>']
    touching = [*problem.obstacles, *problem.pairs]
    rubs = any(one.friction for one in touching)
    lines += _explicit(motion) if motion else _newton(rubs)
    rigid = rigid_surface.parts(problem)
    lines += ["<Material>", *_materials(problem), "</Material>", "<Mesh>", '<Nodes name="nodes">']
    points = np.vstack([mesh.points, *(nodes for nodes, _ in rigid)])
    lines += [f'<node id="{n}">{_row(point)}</node>' for n, point in enumerate(points, 1)]
    lines.append("</Nodes>")
    for i, material in enumerate(problem.materials, 1):
        lines.append(f'<Elements type="hex8" name="part{i}">')
        cells = zip(material.elements + 1, mesh.cells[material.elements] + 1)
        lines += [f'<elem id="{e}">{_row(cell)}</elem>' for e, cell in cells]
        lines.append("</Elements>")
    first = len(mesh.cells) + 1
    for i, (_, cells) in enumerate(rigid, 1):
        lines.append(f'<Elements type="tet4" name="rigid{i}">')
        lines += [f'<elem id="{e}">{_row(cell)}</elem>' for e, cell in enumerate(cells + 1, first)]
        lines.append("</Elements>")
        first += len(cells)
    imposed, applied = problem.imposed(), problem.applied()
    for i, (_, _, nodes) in enumerate([*imposed, *applied], 1):
        lines.append(f'<NodeSet name="set{i}">{_row(nodes + 1)}</NodeSet>')
    if rigid:
        lines.append(f'<NodeSet name="body">{_row(np.arange(1, len(mesh.points) + 1))}</NodeSet>')
    others = [cells[:, 2::-1] for _, cells in rigid] + [pair.other_faces for pair in problem.pairs]
    for i, (one, faces) in enumerate(zip(touching, others), 1):
        lines += _surface(f"first{i}", one.faces) + _surface(f"second{i}", faces)
        lines.append(f'<SurfacePair name="pair{i}">')
        lines.append(f"<primary>first{i}</primary><secondary>second{i}</secondary></SurfacePair>")
    lines += ["</Mesh>", "<MeshDomains>"]
    stiffness = "" if hourglass is None else f"<hg>{float(hourglass)!r}</hg>"
    for i in range(1, len(problem.materials) + 1):
        words = f'name="part{i}" mat="material{i}" type="{element}"'
        lines.append(f"<SolidDomain {words}>{stiffness}</SolidDomain>")
    for i, _ in enumerate(rigid, 1):
        lines.append(f'<SolidDomain name="rigid{i}" mat="rigid{i}" type="rigid-solid"/>')
    lines += ["</MeshDomains>", "<Boundary>"]
    lines += [_imposed(i, *one) for i, one in enumerate(imposed, 1)]
    lines.append("</Boundary>")
    if rigid:
        lines += ["<Rigid>", *_driven(problem.obstacles), "</Rigid>"]
    lines.append("<Loads>")
    lines += [_applied(i, *one) for i, one in enumerate(applied, len(imposed) + 1)]
    lines.append("</Loads>")
    if touching:
        touches = (_touch(i, one, mesh.points) for i, one in enumerate(touching, 1))
        lines += ["<Contact>", *touches, "</Contact>"]
    lines += ["<LoadData>", *_curve(motion), "</LoadData>", "<Output><logfile>"]
    # With all digits, only after the last step.
    body = ' node_set="body"' if rigid else ""
    lines.append(f'<node_data data="ux;uy;uz" delim=" " file="displacement.log"{body}/>')
    return {ENDING: "\n".join([*lines, "</logfile></Output>", "</febio_spec>"]) + "\n"}


def _newton(rubs):
    """The control of a quasi-static analysis. Friction makes its stiffness non-symmetric."""
    kind = "non-symmetric" if rubs else "symmetric"
    return [
        "<Control>",
        "<analysis>STATIC</analysis>",
        f"<time_steps>{LOAD_STEPS}</time_steps><step_size>{1 / LOAD_STEPS!r}</step_size>",
        "<plot_level>PLOT_NEVER</plot_level><output_level>OUTPUT_FINAL</output_level>",
        '<time_stepper type="default"><max_retries>20</max_retries><opt_iter>20</opt_iter>',
        f"<dtmin>1e-6</dtmin><dtmax>{1 / LOAD_STEPS!r}</dtmax></time_stepper>",
        f'<solver type="solid"><symmetric_stiffness>{kind}</symmetric_stiffness>',
        f"<dtol>{TOLERANCE}</dtol><etol>{TOLERANCE}</etol><rtol>{TOLERANCE}</rtol>",
        "<max_refs>50</max_refs><qn_method type='BFGS'><max_ups>0</max_ups></qn_method>",
        "</solver>",
        "</Control>",
    ]


def _explicit(motion):
    """The control of a motion. dyn_damping multiplies velocities once a step."""
    damping = agreed(math.exp(-motion.damping * motion.time_step))
    return [
        "<Control>",
        "<analysis>DYNAMIC</analysis>",
        f"<time_steps>{motion.steps}</time_steps><step_size>{motion.time_step!r}</step_size>",
        "<plot_level>PLOT_NEVER</plot_level><output_level>OUTPUT_FINAL</output_level>",
        f'<solver type="explicit-solid"><dyn_damping>{damping!r}</dyn_damping></solver>',
        "</Control>",
    ]


def _materials(problem):
    """The lines of all materials. Raises InputError for one that FEBio does not have."""
    lines = []
    for i, material in enumerate(problem.materials, 1):
        kind, parameters = LAWS[material.law](material)
        parameters = {"density": material.density, **parameters, "k": material.bulk_modulus}
        words = "".join(f"<{name}>{float(v)!r}</{name}>" for name, v in parameters.items())
        volume = f"<pressure_model>{VOLUMES[material.volumetric]}</pressure_model>"
        lines.append(
            f'<material id="{i}" name="material{i}" type="{kind}">{words}{volume}</material>'
        )
    first = len(problem.materials) + 1
    for i, _ in enumerate(problem.obstacles):
        lines.append(
            f'<material id="{first + i}" name="rigid{i + 1}" type="rigid body">'
            "<density>1.0</density><center_of_mass>0,0,0</center_of_mass></material>"
        )
    return lines


def _surface(name, faces):
    """The lines of a surface of triangles (f, 3) or quadrilaterals (f, 4)."""
    kind = {3: "tri3", 4: "quad4"}[faces.shape[1]]
    rows = (f'<{kind} id="{f}">{_row(face)}</{kind}>' for f, face in enumerate(faces + 1, 1))
    return [f'<Surface name="{name}">', *rows, "</Surface>"]


def _driven(obstacles):
    """The lines that move rigid bodies as obstacles, without turning."""
    lines = []
    for i, obstacle in enumerate(obstacles, 1):
        held = "".join(f"<{dof}_dof>1</{dof}_dof>" for dof in ("Ru", "Rv", "Rw"))
        lines.append(
            f'<rigid_bc name="turn{i}" type="rigid_fixed"><rb>rigid{i}</rb>{held}</rigid_bc>'
        )
        for dof, value in zip(DOFS, obstacle.displacement):
            lines.append(
                f'<rigid_bc name="move{i}{dof}" type="rigid_displacement"><rb>rigid{i}</rb>'
                f'<dof>{dof}</dof><value lc="1">{float(value)!r}</value>'
                "<relative>0</relative></rigid_bc>"
            )
    return lines


def _touch(i, contact, points):
    """An Obstacle or a Pair: a penalty, followed to the depth of the shortest edge."""
    symmetric = 0 if contact.friction else 1
    return (
        f'<contact name="touch{i}" surface_pair="pair{i}" type="sliding-elastic">'
        f"<laugon>PENALTY</laugon><penalty>{float(contact.stiffness)!r}</penalty>"
        f"<search_radius>{rigid_surface.shortest_edge(contact.faces, points)!r}</search_radius>"
        f"<symmetric_stiffness>{symmetric}</symmetric_stiffness>"
        f"<fric_coeff>{float(contact.friction)!r}</fric_coeff></contact>"
    )


def _imposed(i, component, value, _):
    """A boundary condition of the nodes of set i."""
    if not value:
        return (
            f'<bc name="bc{i}" node_set="set{i}" type="zero displacement">'
            f"<{DOFS[component]}_dof>1</{DOFS[component]}_dof></bc>"
        )
    return (
        f'<bc name="bc{i}" node_set="set{i}" type="prescribed displacement">'
        f'<dof>{DOFS[component]}</dof><value lc="1">{float(value)!r}</value>'
        "<relative>0</relative></bc>"
    )


def _applied(i, component, force, _):
    """A load of the nodes of set i."""
    return (
        f'<nodal_load name="load{i}" node_set="set{i}" type="nodal_load">'
        f'<dof>{DOFS[component]}</dof><scale lc="1">{float(force)!r}</scale></nodal_load>'
    )


def _curve(motion):
    """The load controller: linear for a quasi-static case, the loading curve for a motion."""
    times, factors = motion.curve() if motion else (np.array([0.0, 1.0]),) * 2
    points = [f"<pt>{_row(point)}</pt>" for point in np.column_stack([times, factors])]
    return [
        '<load_controller id="1" type="loadcurve"><interpolate>LINEAR</interpolate>',
        "<extend>CONSTANT</extend><points>",
        *points,
        "</points></load_controller>",
    ]


def _row(numbers):
    return ",".join(str(number) for number in numbers.tolist())
