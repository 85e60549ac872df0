"""The scene (.scn) of a case for SOFA, whose one-point hexahedron runs on a CUDA device.

CudaHexahedronTLEDForceField has the project's neo-Hookean energy and a fixed hourglass stiffness.
"""

from xml.sax.saxutils import quoteattr

import numpy as np

from common.hexahedron import gauss_jacobians
from exchange.decks.problem import refuse, agreed

NAME, ENDING = "SOFA", ".scn"
ELEMENTS = ("CudaHexahedronTLEDForceField",)
LAWS = ("neo-hookean",)
VOLUMES = ("quadratic",)
TAKES_HOURGLASS = False

PLUGINS = (
    "SofaCUDA",
    "Sofa.Component.Constraint.Projective",
    "Sofa.Component.Mass",
    "Sofa.Component.ODESolver.Forward",
    "Sofa.Component.Playback",
    "Sofa.Component.StateContainer",
    "Sofa.Component.Topology.Container.Dynamic",
)


def deck(problem, element, hourglass):
    """{ending: text} of a Problem."""
    if len(problem.materials) > 1:
        refuse(problem, NAME, "its force field has one material")
    if np.any(problem.forces):
        refuse(problem, NAME, "its nodal forces do not follow a loading curve")
    if (problem.prescribed.any(axis=1) != problem.prescribed.all(axis=1)).any():
        refuse(problem, NAME, "its constraints on the device hold all components of a node")
    motion, material = problem.motion or problem.relaxation(), problem.materials[0]
    mesh = problem.mesh
    volume = float(gauss_jacobians(mesh.points, mesh.cells).sum())  # m^3
    body = [
        _tag("CentralDifferenceSolver", rayleighMass=motion.damping),
        _tag("MechanicalObject", name="nodes", template="CudaVec3f", position=mesh.points),
        _tag("HexahedronSetTopologyContainer", position="@nodes.position", hexahedra=mesh.cells),
        _tag("HexahedronSetGeometryAlgorithms", template="CudaVec3f"),
        _tag("DiagonalMass", totalMass=agreed(material.density * volume)),
        _tag(
            element,
            youngModulus=material.parameters["young_modulus"],
            poissonRatio=material.parameters["poisson_ratio"],
            timestep=motion.time_step,
        ),
        *_movements(problem, motion),
        _tag("WriteState", filename="sandglass.state", writeX=1, writeX0=1, time=motion.duration),
    ]
    lines = ["<?xml version='1.0'?>", f"<!-- {problem.title} -->"]
    lines += [f'<Node name="root" gravity="0 0 0" dt="{motion.time_step!r}">']
    lines += [_tag("RequiredPlugin", pluginName=name) for name in PLUGINS]
    lines += ["<DefaultAnimationLoop/>", '<Node name="body">', *body, "</Node>", "</Node>"]
    return {ENDING: "\n".join(lines) + "\n"}


def _movements(problem, motion):
    """A constraint for each set of nodes that are moved alike."""
    times, factors = motion.curve()
    nodes = np.flatnonzero(problem.prescribed.all(axis=1))
    values, group = np.unique(problem.values[nodes], axis=0, return_inverse=True)
    return [
        _tag(
            "LinearMovementProjectiveConstraint",
            template="CudaVec3f",
            indices=nodes[group.ravel() == i],
            keyTimes=times,
            movements=np.outer(factors, value),
        )
        for i, value in enumerate(values)
    ]


def _tag(component, /, **attributes):
    """An element of the scene; arrays are written as their numbers."""

    def text(value):
        if isinstance(value, np.ndarray):
            return " ".join(str(number) for number in value.ravel().tolist())
        return str(value)

    words = " ".join(f"{key}={quoteattr(text(value))}" for key, value in attributes.items())
    return f"<{component} {words}/>"
