"""Loads on the mixed problem in FEniCSx: dead tractions, follower pressures, springs, weight."""

import basix
import dolfinx
import numpy as np
import scipy.sparse
import ufl
from dolfinx import fem

# Another process may be compiling the same form: wait for it rather than fail.
JIT_OPTIONS = {"timeout": 600, "cffi_extra_compile_args": ["-O3", "-g0"]}


# Nodes of a cell -> those of its faces: hexahedra of 8 nodes, and tetrahedra of 10, whose 6 edges
# have a node each after the vertices.
_OF_TETRAHEDRON = basix.topology(basix.CellType.tetrahedron)
FACE_NODES = {
    8: basix.topology(basix.CellType.hexahedron)[2],
    10: [
        face + [4 + number for number, edge in enumerate(_OF_TETRAHEDRON[1]) if {*edge} <= {*face}]
        for face in _OF_TETRAHEDRON[2]
    ],
}


class Loads:
    """The loads of a HexMesh on the displacement dofs (N,) of a function.

    mesh: HexMesh. displacement: dolfinx function, m. cell_nodes: (m, 8 or 10) node numbers in the
    space's order of cells and nodes. densities: (m,) of the cells in the order of the space,
    kg/m^3. degree: of the quadrature.
    """

    def __init__(self, mesh, displacement, cell_nodes, densities, degree):
        space = displacement.function_space
        domain, test = space.mesh, ufl.TestFunction(space)
        self._dead = []  # (forces (N,), curve)
        for traction in mesh.tractions:
            measure = _measure(domain, traction.nodes, cell_nodes, degree)
            self._dead.append((_traction_forces(traction, test, measure), traction.curve))
        if any(mesh.gravity):
            self._dead.append((_weight(mesh.gravity, densities, space, test, degree), None))
        self._factors = []  # (constant, curve) of each pressure
        F = ufl.Identity(3) + ufl.grad(displacement)
        normal = ufl.FacetNormal(domain)
        forms = []
        for surface in mesh.surfaces:
            measure = _measure(domain, surface.nodes, cell_nodes, degree)
            if surface.pressure:
                turned = ufl.cofac(F) * normal  # Nanson: n da, of an undeformed unit area
                factor = fem.Constant(domain, 1.0)
                self._factors.append((factor, surface.curve))
                value = factor * fem.Constant(domain, surface.pressure)
                forms.append(value * ufl.inner(turned, test) * measure)
            if surface.stiffness:
                moved = displacement
                if surface.only_normal:
                    moved = ufl.inner(displacement, normal) * normal
                forms.append(
                    fem.Constant(domain, surface.stiffness) * ufl.inner(moved, test) * measure
                )
        self.symmetric = not any(surface.pressure for surface in mesh.surfaces)
        # Each with its own measure, which a common form cannot have.
        trial = ufl.TrialFunction(space)
        self._forms = [
            [
                fem.form(form, jit_params=JIT_OPTIONS)
                for form in (vector, ufl.derivative(vector, displacement, trial))
            ]
            for vector in forms
        ]

    def forces(self, factor_of):
        """Minus the loads (N,) in N in the current configuration.

        factor_of: function from a load's curve (None: that of the case) to its factor.
        """
        self._set(factor_of)
        dead = sum((factor_of(curve) * forces for forces, curve in self._dead), 0.0)
        return sum((fem.assemble_vector(vector).array for vector, _ in self._forms), -dead)

    def tangent(self, factor_of):
        """The derivative (N, N) of forces() by the displacement, N/m; 0 if they are constant."""
        self._set(factor_of)
        return sum((assembled(matrix) for _, matrix in self._forms), 0)

    def _set(self, factor_of):
        for factor, curve in self._factors:
            factor.value = factor_of(curve)


def assembled(form, matrix=None):
    """The sparse matrix of a form. matrix: from create_matrix(form), to assemble into and keep."""
    into = matrix or fem.petsc.create_matrix(form)
    into.zeroEntries()
    fem.petsc.assemble_matrix(into, form)
    into.assemble()
    indptr, indices, data = into.getValuesCSR()
    size = into.getSize()
    if matrix is None:
        into.destroy()
    return scipy.sparse.csr_matrix((data, indices, indptr), shape=size)


def _measure(domain, nodes, cell_nodes, degree):
    """The measure on the boundary faces whose nodes all lie in a set. nodes: (n,) bool."""
    domain.topology.create_connectivity(2, 3)
    domain.topology.create_connectivity(3, 2)
    facets = []
    for facet in dolfinx.mesh.exterior_facet_indices(domain.topology):
        (cell,) = domain.topology.connectivity(2, 3).links(facet)
        local = list(domain.topology.connectivity(3, 2).links(cell)).index(facet)
        if nodes[cell_nodes[cell, FACE_NODES[len(cell_nodes[cell])][local]]].all():
            facets.append(facet)
    facets = np.sort(np.array(facets, dtype=np.int32))
    tags = dolfinx.mesh.meshtags(domain, 2, facets, np.ones_like(facets))
    data = {"quadrature_rule": "default", "quadrature_degree": degree}
    return ufl.Measure("ds", domain=domain, subdomain_data=tags, metadata=data)(1)


def _traction_forces(traction, test, measure):
    """Nodal forces (N,) in N of a Traction at full load."""
    domain = measure.ufl_domain()
    mean, turn, centre = (
        fem.Constant(domain, vector) for vector in (traction.mean, traction.turn, traction.centre)
    )
    t = mean + ufl.cross(turn, ufl.SpatialCoordinate(domain) - centre)
    return fem.assemble_vector(fem.form(ufl.inner(t, test) * measure)).array.copy()


def _weight(gravity, densities, space, test, degree):
    """Nodal forces (N,) in N of an acceleration (3,) in m/s^2."""
    domain = space.mesh
    density = fem.Function(fem.FunctionSpace(domain, ("DG", 0)))
    density.x.array[:] = densities
    data = {"quadrature_rule": "default", "quadrature_degree": degree}
    measure = ufl.Measure("dx", domain=domain, metadata=data)
    g = fem.Constant(domain, np.asarray(gravity, dtype=float))
    form = fem.form(density * ufl.inner(g, test) * measure, jit_params=JIT_OPTIONS)
    return fem.assemble_vector(form).array.copy()
