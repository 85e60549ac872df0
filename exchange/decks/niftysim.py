"""The model file (.xml) of a case for NiftySim, which integrates in time with one-point hexahedra.

Its neo-Hookean energy mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2 is the project's, its loading curve
POLY345 the paper's. It has no smooth curve that is then held.
"""

from exchange.decks.contact import Expressible
from exchange.decks.problem import refuse

NAME, ENDING = "NiftySim", ".xml"
ELEMENTS = ("H8",)
LAWS = ("neo-hookean",)
VOLUMES = ("quadratic",)
USUAL_HOURGLASS = 0.075  # HGKappa in its own example models
TAKES_HOURGLASS = True
TAKES_HANGING_NODES = False
CONTACT = Expressible()


def deck(problem, element, hourglass):
    """{ending: text} of a Problem. hourglass: HGKappa, or None for the usual one."""
    motion = problem.motion or problem.relaxation()
    if motion.ramp_steps != motion.steps:
        refuse(problem, NAME, "its loading curve lasts as long as the motion: ramp_time = duration")
    mesh = problem.mesh
    lines = [
        "<?xml version='1.0' encoding='utf-8'?>",
        f"<!-- {problem.title} -->",
        "<Model>",
    ]
    lines += [f'<Nodes DOF="3" NumNodes="{len(mesh.points)}">', *map(_row, mesh.points), "</Nodes>"]
    lines += [f'<Elements NumEls="{len(mesh.cells)}" Type="{element}">', *map(_row, mesh.cells)]
    lines += ["</Elements>", *(line for m in problem.materials for line in _element_set(m))]
    for component, value, nodes in problem.imposed():
        lines += _constraint("Disp" if value else "Fix", component, nodes, value)
    for component, force, nodes in problem.applied():
        lines += _constraint("Force", component, nodes, force)
    parameters = {
        "TimeStep": motion.time_step,
        "TotalTime": motion.duration,
        "DampingCoeff": motion.damping,
        "HGKappa": USUAL_HOURGLASS if hourglass is None else hourglass,
        "Density": problem.materials[0].density,
    }
    lines += ["<SystemParams>", *(f"<{k}>{float(v)!r}</{k}>" for k, v in parameters.items())]
    # Only the last step.
    lines += ["</SystemParams>", f'<Output Freq="{motion.steps}"><Variable>U</Variable></Output>']
    return {ENDING: "\n".join([*lines, "</Model>"]) + "\n"}


def _row(numbers):
    return " ".join(str(number) for number in numbers.tolist())


def _element_set(material):
    """The lines of the elements of one Material."""
    moduli = f"{float(material.shear_modulus)!r} {float(material.bulk_modulus)!r}"
    return [
        f'<ElementSet Size="{len(material.elements)}">',
        f'<Material Type="NH"><ElasticParams NumParams="2">{moduli}</ElasticParams>'
        f"<Density>{float(material.density)!r}</Density></Material>",
        _row(material.elements),
        "</ElementSet>",
    ]


def _constraint(kind, component, nodes, value):
    """The lines of a constraint or load of several nodes."""
    shape = "" if kind == "Fix" else ' LoadShape="POLY345"'
    size = "" if kind == "Fix" else f'<Magnitudes Type="UNIFORM">{float(value)!r}</Magnitudes>'
    return [
        f'<Constraint DOF="{component}" NumNodes="{len(nodes)}" Type="{kind}"{shape}>',
        f"<Nodes>{_row(nodes)}</Nodes>{size}",
        "</Constraint>",
    ]
