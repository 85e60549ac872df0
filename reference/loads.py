"""Loads on the mixed problem in FEniCSx: dead tractions, follower pressures, springs, weight,
contact."""

import basix
import dolfinx
import numpy as np
import scipy.sparse
import ufl
from dolfinx import fem

from common.hexahedron import gauss_jacobians
from contact import Contact
from laws import young_modulus

# Another process may be compiling the same form: wait for it rather than fail.
JIT_OPTIONS = {"timeout": 600, "cffi_extra_compile_args": ["-O3", "-g0"]}


# Nodes of a cell -> those of its edges and faces: hexahedra of 8 nodes, and tetrahedra of 10, whose
# 6 edges have a node each after the vertices.
_OF_HEXAHEDRON, _OF_TETRAHEDRON = (
    basix.topology(kind) for kind in (basix.CellType.hexahedron, basix.CellType.tetrahedron)
)
EDGES = {8: np.array(_OF_HEXAHEDRON[1]), 10: np.array(_OF_TETRAHEDRON[1])}
FACE_NODES = {
    8: _OF_HEXAHEDRON[2],
    10: [
        face + [4 + number for number, edge in enumerate(_OF_TETRAHEDRON[1]) if {*edge} <= {*face}]
        for face in _OF_TETRAHEDRON[2]
    ],
}


class Loads:
    """The loads of a HexMesh on the displacement dofs (N,) of a function.

    mesh: HexMesh. materials: list of Material. displacement: dolfinx function, m. cell_nodes: (m,
    8 or 10) node numbers in the space's order of cells and nodes. degree: of the quadrature.
    Attributes: masses (N,) of the dofs, kg, see _masses; contacts, a Contact for each obstacle;
    symmetric (whether the tangent is).
    """

    def __init__(self, mesh, materials, displacement, cell_nodes, degree):
        space = displacement.function_space
        domain, test = space.mesh, ufl.TestFunction(space)
        densities = [m.density for m in materials]
        self._dead = []  # (forces (N,), curve)
        for traction in mesh.tractions:
            measure = _measure(domain, traction.nodes, cell_nodes, degree)
            self._dead.append((_traction_forces(traction, test, measure), traction.curve))
        lumped = len(cell_nodes[0]) == 8
        of_cells = _of_cells(mesh, densities) if lumped else None
        self.masses = _masses(mesh, space, cell_nodes, of_cells)
        for one in mesh.gravity:
            weight = self.masses * np.tile(one.value, len(self.masses) // 3)
            if not lumped:
                own = _per_cell(domain, mesh, densities)
                weight += _weight(one.value, own, space, test, degree)
            self._dead.append((weight, one.curve))
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
        self._displacement, self.contacts = displacement, []
        for touching in mesh.touching:
            faces, cells = _faces(domain, touching.nodes, cell_nodes)
            areas = _areas(test, _on_faces(domain, faces, degree))
            if len(cell_nodes[0]) == 10:  # integrals over quadratic triangles need no vertices
                areas[space.dofmap.list.array.reshape(-1, 10)[:, :4]] = 0.0
            ends = mesh.points[cell_nodes[cells][:, EDGES[len(cell_nodes[0])]]]
            edge = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2).min()
            moduli = [young_modulus(m.law, m.parameters) for m in materials]
            modulus = _per_cell(domain, mesh, moduli)[cells].min()
            places = space.tabulate_dof_coordinates()
            self.contacts.append(Contact(touching.obstacle, places, areas, modulus, edge))
        # Each needs its own measure, so they cannot share a form.
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
        total = sum((-factor_of(curve) * forces for forces, curve in self._dead), 0.0)
        for contact in self.contacts:
            total = total + contact.forces(self._displacement.x.array, factor_of(None))
        return sum((fem.assemble_vector(vector).array for vector, _ in self._forms), total)

    def tangent(self, factor_of):
        """The derivative (N, N) of forces() by the displacement, N/m; 0 if they are constant."""
        self._set(factor_of)
        u, load = self._displacement.x.array, factor_of(None)
        touching = sum((contact.tangent(u, load) for contact in self.contacts), 0)
        return sum((assembled(matrix) for _, matrix in self._forms), touching)

    def augment(self, factor_of):
        """The largest Contact.augment() of all contacts."""
        u, load = self._displacement.x.array, factor_of(None)
        return max((contact.augment(u, load) for contact in self.contacts), default=0.0)

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


def _of_cells(mesh, values):
    """Values of the materials of a HexMesh for each of its cells (m,)."""
    numbers = np.zeros(len(mesh.cells), dtype=int) if len(values) == 1 else mesh.materials
    return np.array(values)[numbers]


def _per_cell(domain, mesh, values):
    """The same in dolfinx's order."""
    return _of_cells(mesh, values)[np.asarray(domain.topology.original_cell_index)]


def _measure(domain, nodes, cell_nodes, degree):
    """The measure on the boundary faces whose nodes all lie in a set. nodes: (n,) bool."""
    return _on_faces(domain, _faces(domain, nodes, cell_nodes)[0], degree)


def _faces(domain, nodes, cell_nodes):
    """Those boundary faces, in ascending order, and the cells that they belong to."""
    domain.topology.create_connectivity(2, 3)
    domain.topology.create_connectivity(3, 2)
    found = []
    for facet in dolfinx.mesh.exterior_facet_indices(domain.topology):
        (cell,) = domain.topology.connectivity(2, 3).links(facet)
        local = list(domain.topology.connectivity(3, 2).links(cell)).index(facet)
        if nodes[cell_nodes[cell, FACE_NODES[len(cell_nodes[cell])][local]]].all():
            found.append((facet, cell))
    return np.array(sorted(found), dtype=np.int32).reshape(-1, 2).T


def _on_faces(domain, facets, degree):
    """The measure on faces in ascending order."""
    tags = dolfinx.mesh.meshtags(domain, 2, facets, np.ones_like(facets))
    data = {"quadrature_rule": "default", "quadrature_degree": degree}
    return ufl.Measure("ds", domain=domain, subdomain_data=tags, metadata=data)(1)


def _areas(test, measure):
    """The integral (n,) in m^2 of each node's shape function over faces."""
    one = fem.Constant(measure.ufl_domain(), (1.0, 0.0, 0.0))
    form = fem.form(ufl.inner(one, test) * measure, jit_params=JIT_OPTIONS)
    return fem.assemble_vector(form).array.reshape(-1, 3)[:, 0].copy()


def _traction_forces(traction, test, measure):
    """Nodal forces (N,) in N of a Traction at full load."""
    domain = measure.ufl_domain()
    mean, turn, centre = (
        fem.Constant(domain, vector) for vector in (traction.mean, traction.turn, traction.centre)
    )
    t = mean + ufl.cross(turn, ufl.SpatialCoordinate(domain) - centre)
    return fem.assemble_vector(fem.form(ufl.inner(t, test) * measure)).array.copy()


def _masses(mesh, space, cell_nodes, densities):
    """The masses (N,) of the displacement dofs, kg: those attached to the nodes of a HexMesh and,
    with densities (m,) of its hexahedra, an eighth of each one's own at each of its vertices, as in
    solver/problem/masses.cpp."""
    of_nodes = np.zeros(cell_nodes.max() + 1)
    for one in mesh.masses:
        of_nodes[np.flatnonzero(one.nodes)] += one.total / one.nodes.sum()
    if densities is not None:
        eighths = densities * gauss_jacobians(mesh.points, mesh.cells).sum(axis=0) / 8
        np.add.at(of_nodes, mesh.cells, eighths[:, None])
    of_blocks = np.zeros(space.dofmap.index_map.size_local)
    of_blocks[space.dofmap.list.array.reshape(cell_nodes.shape)] = of_nodes[cell_nodes]
    return np.repeat(of_blocks, 3)


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
