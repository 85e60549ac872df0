"""The mixed problem on quadratic tetrahedra with a linear pressure, continuous in each material
(Taylor-Hood)."""

import dolfinx
import numpy as np
import scipy.sparse
import ufl
from dolfinx import fem
from mpi4py import MPI
from scipy.spatial import cKDTree

from loads import Loads, assembled
from newton import Problem, Unknown
from problem import compile_forms
from tetrahedra import EDGES

# Of the quadrature. Elements that fold at an edge invert at points near their faces first: with
# degree 6, which lies closer to them, Newton's method needs many more steps.
DEGREE = 4


class TaylorHoodProblem(Problem):
    """Equilibrium on quadratic tetrahedra, as newton.solve() needs it.

    mesh: HexMesh of tetrahedra.cut(). materials: list of Material. A continuous pressure cannot be
    eliminated element by element: unknowns are displacements and pressures together, the latter
    over a stiffness (Pa/m) that makes both blocks of the tangent alike.
    Attributes: as of a MixedProblem; mesh; displacement holds all unknowns; function is the
    displacement (dolfinx function, m) where the residual was last computed.
    """

    def __init__(self, mesh, materials):
        self.mesh = mesh
        element = ufl.VectorElement("Lagrange", "tetrahedron", 2)
        domain = dolfinx.mesh.create_mesh(MPI.COMM_SELF, mesh.cells, mesh.points, ufl.Mesh(element))
        self.function = fem.Function(fem.FunctionSpace(domain, element))
        self._p = fem.Function(fem.FunctionSpace(domain, ("DG", 1)))
        self._forms = compile_forms(self.function, self._p, mesh, materials, DEGREE)
        # Geometry and displacement number the nodes of a cell alike: see MixedProblem.
        geometry = domain.geometry.dofmap.array.reshape(-1, 10)
        self._cells = np.asarray(domain.geometry.input_global_indices)[geometry]
        block = self.function.function_space.dofmap.list.array.reshape(-1, 10)
        self._block = np.empty(len(mesh.points), dtype=np.int64)
        self._block[self._cells] = block
        # The pressure jumps between two materials: each has its own pressure there.
        of_cell = np.zeros(len(self._cells), dtype=np.int64)
        if mesh.materials is not None:
            of_cell[:] = mesh.materials[np.asarray(domain.topology.original_cell_index)]
        places = self._cells[:, :4] + len(mesh.points) * of_cell[:, None]
        used, number = np.unique(places, return_inverse=True)
        dofs = self._p.function_space.dofmap.list.array
        ones = np.ones(len(dofs))
        self._of_cells = scipy.sparse.csr_matrix((ones, (dofs, number.ravel())))
        self._place = used  # of each pressure unknown: node + nodes * material
        self.loads = Loads(mesh, materials, self.function, self._cells, DEGREE)
        self.symmetric = self.loads.symmetric
        self._n = self.function.x.array.size
        self.displacement = Unknown(self._n + len(used))
        self.pressure = Unknown(0)
        dofs = 3 * self._block[:, None] + np.arange(3)
        self.impose(mesh, dofs, self.displacement.array.size)
        forms = self._forms["matrices"]
        uu, pp = assembled(forms["uu"]), self._of_cells.T @ assembled(forms["pp"]) @ self._of_cells
        self._stiffness = np.sqrt(-uu.diagonal().mean() / pp.diagonal().mean())

    def multipliers(self):
        """See newton.Problem."""
        return [contact.multipliers for contact in self.loads.contacts]

    def augment(self):
        """See newton.Problem."""
        return self.loads.augment(self._factor)

    def nodal_displacement(self):
        """Displacement (n, 3) in m at the nodes of the mesh, in its numbering."""
        return self.displacement.array[: self._n].reshape(-1, 3)[self._block]

    def size(self):
        """Numbers of elements and unknowns as text."""
        return f"{len(self.mesh.cells)} tetrahedra, {self.displacement.array.size} unknowns"

    def nodal_forces(self):
        """Unbalanced forces (n, 3) in N at the nodes of the mesh, in its numbering."""
        return self.mixed_residual()[0][: self._n].reshape(-1, 3)[self._block]

    def start_from(self, coarse, share=None):
        """Interpolate displacement and pressure from a TaylorHoodProblem on another mesh.

        share: their weight at the nodes (n,), the rest being the previous values; None: 1.
        """
        mesh, other = self.mesh, coarse.mesh
        cell, places = locate(mesh.points, other.points, other.cells)
        u = coarse.nodal_displacement()[other.cells[cell]]
        materials = 0 if mesh.materials is None else other.materials[cell][:, None]
        p = coarse._pressure_at(other.cells[cell][:, :4] + len(other.points) * materials)
        u = np.einsum("ka,kai->ki", _quadratic(places), u)
        p = np.einsum("ka,ka->k", places, p) / self._stiffness
        share = np.ones(len(mesh.points)) if share is None else share
        at = self._place % len(mesh.points)
        nodal, pressures = np.split(self.displacement.array, [self._n])
        nodal = nodal.reshape(-1, 3)
        nodal[self._block] += share[:, None] * (u - nodal[self._block])
        pressures += share[at] * (p[at] - pressures)

    def mixed_residual(self):
        """Unbalanced forces (N,) in N of all unknowns, and an empty row."""
        self._move()
        vectors = self._forms["vectors"]
        forces = fem.assemble_vector(vectors["u"]).array + self.loads.forces(self._factor)
        dilatation = fem.assemble_vector(vectors["p"]).array
        dilatation = self._stiffness * (self._of_cells.T @ dilatation)
        return np.concatenate([forces, dilatation]), np.empty(0)

    def linearize(self):
        """See MixedProblem.linearize: nothing is eliminated here."""
        residual, _ = self.mixed_residual()
        forms, follow = self._forms["matrices"], self._stiffness * self._of_cells
        uu = assembled(forms["uu"]) + self.loads.tangent(self._factor)
        up, pp = assembled(forms["up"]) @ follow, follow.T @ assembled(forms["pp"]) @ follow
        tangent = scipy.sparse.bmat([[uu, up], [up.T, pp]], format="csr")
        return tangent, residual, lambda _: np.empty(0)

    def _factor(self, _curve):
        return self.load

    def _move(self):
        self.function.x.array[:] = self.displacement.array[: self._n]
        self._p.x.array[:] = self._stiffness * (self._of_cells @ self.displacement.array[self._n :])

    def _pressure_at(self, places):
        """Pressures in Pa at `places`: node + nodes * material."""
        return (
            self._stiffness
            * self.displacement.array[self._n + np.searchsorted(self._place, places)]
        )


def _quadratic(places):
    """The ten shape functions (k, 10) at barycentric coordinates (k, 4)."""
    on_edges = 4 * places[:, EDGES[:, 0]] * places[:, EDGES[:, 1]]
    return np.concatenate([places * (2 * places - 1), on_edges], axis=1)


def _slopes(places):
    """Derivatives (k, 10, 3) of the shape functions by the last three barycentric coordinates."""
    by = np.zeros((len(places), 10, 4))
    for v in range(4):
        by[:, v, v] = 4 * places[:, v] - 1
    for e, (a, b) in enumerate(EDGES):
        by[:, 4 + e, a], by[:, 4 + e, b] = 4 * places[:, b], 4 * places[:, a]
    return by[:, :, 1:] - by[:, :, :1]


def locate(targets, points, cells, candidates=40):
    """The quadratic tetrahedron of each target (k, 3), and the barycentric coordinates in it.

    Newton's method in the tetrahedra with the nearest centres; the one that comes closest to
    holding the target counts. points: (n, 3). cells: (m, 10). Returns (k,), (k, 4).
    """
    tree = cKDTree(points[cells[:, :4]].mean(axis=1))
    _, near = tree.query(targets, min(candidates, len(cells)))
    best = np.full(len(targets), -np.inf)
    cell, found = np.zeros(len(targets), dtype=int), np.zeros((len(targets), 4))
    for tried in near.T:
        open_ = np.flatnonzero(best < -1e-9)
        if not open_.size:
            break
        nodes = points[cells[tried[open_]]]
        places = np.full((len(open_), 4), 0.25)
        for _ in range(6):
            gap = targets[open_] - np.einsum("ka,kai->ki", _quadratic(places), nodes)
            jacobian = np.einsum("kaj,kai->kij", _slopes(places), nodes)
            step = np.linalg.solve(jacobian, gap[..., None])[..., 0]
            places[:, 1:] += np.clip(step, -1, 1)
            places[:, 0] = 1 - places[:, 1:].sum(axis=1)
        inside = places.min(axis=1)
        better = inside > best[open_]
        rows = open_[better]
        best[rows], cell[rows], found[rows] = inside[better], tried[rows], places[better]
    return cell, found
