"""Derivatives of a scalar of a static answer by the adjoint problem, in FEniCSx.

An oracle for sandglass.Solution.gradient: the golden's element is tl-mean-dilatation's, so that
both must agree to the residuals of their answers. FEniCSx differentiates the energy symbolically.
"""

from dataclasses import dataclass

import numpy as np
import ufl
from dolfinx import fem
from scipy.sparse.linalg import spsolve

from laws import energy
from loads import JIT_OPTIONS
from problem import QUADRATURE


@dataclass(frozen=True)
class Adjoint:
    """The derivatives of a scalar J of the displacements.

    parameters: of each material, name -> (m,), by a parameter of its law in each element, in the
    order of the mesh; zero in elements of others.
    forces: (n, 3), by a force on each node, 1/N. imposed: (n, 3), by imposed displacements, 1/m.
    """

    parameters: tuple
    forces: np.ndarray
    imposed: np.ndarray


def adjoint(problem, materials, of_displacement):
    """The Adjoint at the equilibrium of a MixedProblem.

    materials: list of Material. of_displacement: dJ/du, (n, 3). The elements' pressures are
    eliminated as in a Newton step. Pressures that follow the body are not supported: tangents must
    be symmetric.
    """
    assert problem.symmetric
    tangent, _, recover = problem.linearize()
    slope = problem.dofs_of(of_displacement)
    of_u = np.zeros_like(slope)
    free, fixed = problem.free, problem.fixed
    of_u[free] = spsolve(tangent[free][:, free].tocsc(), slope[free])
    imposed = np.zeros_like(slope)
    imposed[fixed] = slope[fixed] - tangent[fixed][:, free] @ of_u[free]
    of_p = recover(of_u)  # the residual of the dilatation is that of the answer: zero
    parameters = _by_parameters(problem, materials, of_u, of_p)
    return Adjoint(parameters, *(problem.nodal(field) for field in (of_u, imposed)))


def _by_parameters(problem, materials, of_u, of_p):
    """Minus the change of both residuals with each element's parameters, times the adjoints."""
    u, p = problem.displacement, problem.pressure
    domain = u.function_space.mesh
    original = np.asarray(domain.topology.original_cell_index)
    cells = fem.FunctionSpace(domain, ("DG", 0))
    along_u, along_p = fem.Function(u.function_space), fem.Function(p.function_space)
    along_u.x.array[:], along_p.x.array[:] = of_u, of_p
    F = ufl.Identity(3) + ufl.grad(u)
    measure = ufl.dx(metadata={"quadrature_rule": "default", "quadrature_degree": QUADRATURE})
    numbers = problem.material_numbers
    found = []
    for number, material in enumerate(materials):
        fields = {name: fem.Function(cells) for name in material.parameters}
        for name, field in fields.items():
            field.x.array[:] = material.parameters[name]
        total = energy(material.law, material.volumetric, F, p, **fields) * measure
        along = ufl.derivative(total, u, along_u) + ufl.derivative(total, p, along_p)
        own = np.ones(len(original)) if numbers is None else numbers == number
        found.append({})
        for name, field in fields.items():
            form = ufl.derivative(along, field, ufl.TestFunction(cells))
            vector = fem.assemble_vector(fem.form(form, jit_params=JIT_OPTIONS))
            found[-1][name] = np.zeros(len(original))
            found[-1][name][original] = -vector.array
            found[-1][name] *= own
    return tuple(found)
