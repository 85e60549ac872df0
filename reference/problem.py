"""The mixed displacement-pressure problem on a mesh of hexahedra, assembled with FEniCSx.

Each element has its own pressure, so every Newton step eliminates it exactly on the element level
(static condensation), which leaves a symmetric system in the displacement only.
"""

from functools import partial

import basix
import dolfinx
import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI

from common.hexahedron import LEXICOGRAPHIC
from laws import energy
from loads import JIT_OPTIONS, Loads, assembled
from newton import Problem, condensed


QUADRATURE = 3  # the degree that 2 x 2 x 2 Gauss points integrate


class MixedProblem(Problem):
    """Equilibrium of a HexMesh: residual and tangent in the displacement's unknowns.

    The golden's element: a trilinear displacement and one pressure (Q1-P0), 2 x 2 x 2 Gauss points.

    mesh: HexMesh. materials: list of Material, to which the mesh's material numbers refer.
    Attributes, beside those of a Problem: displacement and pressure (dolfinx functions, m and Pa),
    symmetric (whether tangents are), material_numbers (m,) of the elements of the mesh, or None.
    """

    def __init__(self, mesh, materials):
        vertex = ufl.VectorElement("Lagrange", "hexahedron", 1)
        lexicographic = mesh.cells[:, LEXICOGRAPHIC]
        domain = dolfinx.mesh.create_mesh(
            MPI.COMM_SELF, lexicographic, mesh.points, ufl.Mesh(vertex)
        )
        self.displacement = fem.Function(fem.FunctionSpace(domain, vertex))
        self.pressure = fem.Function(fem.FunctionSpace(domain, ("DG", 0)))
        points, _ = basix.make_quadrature(basix.CellType.hexahedron, QUADRATURE)
        assert len(points) == 8, "FEniCSx chose another Gauss rule"
        self._forms = compile_forms(self.displacement, self.pressure, mesh, materials, QUADRATURE)
        self._matrices = {
            name: fem.petsc.create_matrix(form) for name, form in self._forms["matrices"].items()
        }
        # dolfinx reorders cells and nodes on input. Geometry and displacement number the vertices
        # of a cell in the same order, which gives the caller's node numbers cell by cell.
        n_cells = len(mesh.cells)
        geometry = domain.geometry.dofmap.array.reshape(n_cells, 8)
        cell_nodes = np.asarray(domain.geometry.input_global_indices)[geometry]
        space = self.displacement.function_space
        self._vertex_block = np.empty(len(mesh.points), dtype=np.int64)
        self._vertex_block[cell_nodes] = space.dofmap.list.array.reshape(n_cells, 8)
        dofs = 3 * self._vertex_block[:, None] + np.arange(3)
        self.impose(mesh, dofs, self.displacement.x.array.size)
        self.loads = Loads(mesh, materials, self.displacement, cell_nodes, QUADRATURE)
        self.symmetric = self.loads.symmetric
        self.material_numbers = mesh.materials

    def start_from(self, coarse):
        """Interpolate displacement and pressure from a problem on the mesh before refine().

        coarse: MixedProblem with the same elements. The finer spaces contain the coarser ones, so
        the interpolation is exact.
        """
        domain, coarse_domain = (
            problem.displacement.function_space.mesh for problem in (self, coarse)
        )
        number = np.argsort(coarse_domain.topology.original_cell_index)
        parents = number[np.asarray(domain.topology.original_cell_index) // 8].astype(np.int32)

        def take_over(finer, coarser):
            def values(x):  # (3, points of all cells in turn)
                return coarser.eval(x.T, np.repeat(parents, x.shape[1] // len(parents))).T

            finer.interpolate(values)

        take_over(self.displacement, coarse.displacement)
        take_over(self.pressure, coarse.pressure)

    def factor_of(self, _curve):
        """The current factor of a load: in a quasi-static case no load has its own curve."""
        return self.load

    def dofs_of(self, nodal):
        """Values (n, 3) at the nodes of the HexMesh as values of the displacement dofs (N,)."""
        dofs = np.zeros((self.displacement.x.array.size // 3, 3))
        dofs[self._vertex_block] = nodal
        return dofs.ravel()

    def multipliers(self):
        """See newton.Problem."""
        return [contact.multipliers for contact in self.loads.contacts]

    def augment(self):
        """See newton.Problem."""
        return self.loads.augment(self.factor_of)

    def nodal(self, dofs):
        """Values of the displacement dofs (N,) at the nodes of the HexMesh, (n, 3)."""
        return dofs.reshape(-1, 3)[self._vertex_block]

    def nodal_displacement(self):
        """Displacement (n, 3) in m at the nodes of the HexMesh, in its numbering."""
        return self.nodal(self.displacement.x.array)

    def nodal_points(self):
        """Undeformed points (n, 3) in m according to the displacement's space, in the same order.

        They equal the HexMesh's points if and only if the numbering is right.
        """
        space = self.displacement.function_space
        return space.tabulate_dof_coordinates()[self._vertex_block]

    def energy(self):
        """The strain energy at the current displacement and pressure, J."""
        return fem.assemble_scalar(self._forms["scalars"]["energy"])

    def linearize(self):
        """Residual and tangent at the current displacement and pressure, pressure eliminated.

        Returns (tangent, residual, recover): sparse (N, N) in N/m and (N,) in N over all
        displacement dofs, and a function from a displacement increment (N,) to the pressure
        increment of the same Newton step.
        """
        uu, up, pp = map(self._assemble_matrix, ("uu", "up", "pp"))
        uu = uu + self.loads.tangent(self.factor_of)
        return condensed((uu, up, up.T, pp), *self.mixed_residual())

    def mixed_residual(self):
        """Both rows of the mixed system: forces (N,) in N, and (M,) in m^3, one per pressure.

        The forces are the internal forces minus the loads at the current factor.
        """
        forces = self._assemble_vector("u") + self.loads.forces(self.factor_of)
        return forces, self._assemble_vector("p")

    def _assemble_matrix(self, name):
        return assembled(self._forms["matrices"][name], self._matrices[name])

    def _assemble_vector(self, name):
        return fem.assemble_vector(self._forms["vectors"][name]).array


def compile_forms(u, p, mesh, materials, degree):
    """First and second derivatives of the energy with respect to displacement and pressure.

    u, p: dolfinx functions on a domain made from a HexMesh. materials: list of Material. degree: of
    the quadrature. Returns "scalars", "vectors" and "matrices" -> name -> compiled form.
    """
    domain = u.function_space.mesh
    # Constants rather than literals, so that one compiled form serves every case.
    laws = [
        partial(
            energy,
            m.law,
            m.volumetric,
            **{k: fem.Constant(domain, v) for k, v in m.parameters.items()},
        )
        for m in materials
    ]
    original = np.asarray(domain.topology.original_cell_index)
    measure = ufl.dx(metadata={"quadrature_rule": "default", "quadrature_degree": degree})
    parts = [measure]
    if len(laws) > 1:
        numbers = mesh.materials[original].astype(np.int32)
        cells = np.arange(len(numbers), dtype=np.int32)
        tags = dolfinx.mesh.meshtags(domain, 3, cells, numbers)
        parts = [measure(number, subdomain_data=tags) for number in range(len(laws))]
    F = ufl.Identity(3) + ufl.grad(u)
    if mesh.axes is not None:  # laws take F in material axes
        tensors = ufl.TensorElement("DG", domain.ufl_cell(), 0)
        axes = fem.Function(fem.FunctionSpace(domain, tensors))
        axes.x.array[:] = mesh.axes[original].ravel()
        F = axes * F * axes.T
    total = sum(law(F, p) * part for law, part in zip(laws, parts, strict=True))
    v, du = ufl.TestFunction(u.function_space), ufl.TrialFunction(u.function_space)
    q, dp = ufl.TestFunction(p.function_space), ufl.TrialFunction(p.function_space)
    by_u, by_p = ufl.derivative(total, u, v), ufl.derivative(total, p, q)
    forms = {
        "scalars": {"energy": total},
        "vectors": {"u": by_u, "p": by_p},
        "matrices": {
            "uu": ufl.derivative(by_u, u, du),
            "up": ufl.derivative(by_u, p, dp),
            "pp": ufl.derivative(by_p, p, dp),
        },
    }
    return {
        kind: {name: fem.form(form, jit_params=JIT_OPTIONS) for name, form in group.items()}
        for kind, group in forms.items()
    }
