"""Goldens by a second program: GetFEM, with weak forms in its own language.

Elements, quadrature and the symbolic derivatives of the weak form are GetFEM's; its stresses are
derived by hand, whereas FEniCSx derives them from the energy. Only Newton's method and the linear
solver are the reference's; they affect the speed, not the answer.
"""

import re
from dataclasses import dataclass

import getfem
import numpy as np
import scipy.sparse

from common.errors import InputError
from common.hexahedron import CORNERS, LEXICOGRAPHIC
from contact import LIMIT_PENALTY
from laws import young_modulus
from newton import Problem, Unknown, condensed

getfem.util_trace_level(0)

# The derivative of the isochoric energy by x = I1bar - 3, and the bulk modulus.
LAWS = {
    "neo-hookean": (
        "young_modulus / 4 / (1 + poisson_ratio)",
        "young_modulus / 3 / (1 - 2 * poisson_ratio)",
    ),
    "yeoh": ("c1 + 2 * c2 * x + 3 * c3 * sqr(x)", "bulk_modulus"),
}
# The corners of the reference element, and those of its faces, both in GetFEM's order.
REFERENCE = CORNERS[LEXICOGRAPHIC]
FACES = [np.flatnonzero(REFERENCE[:, axis] == side) for axis in range(3) for side in (1, -1)]
# The weak form of balance, of the first Piola-Kirchhoff stress, and of p = K (J - 1).
FORM = """
Def F := (Id(3) + Grad_u);
Def J := Det(F);
Def x := (pow(J, -2/3) * Norm_sqr(F) - 3);
(2 * ({slope}) * pow(J, -2/3) * (F - Norm_sqr(F) / 3 * Inv(F)') + pressure * J * Inv(F)')
: Grad_Test_u
+ (J - 1 - pressure / ({bulk})) * Test_pressure
"""
# Functions of the place x that are zero on a shape, positive outside, and there about as steep as a
# distance. Without penetration, contact needs only these: at a touching node their gradient is
# along the normal. They grow linearly along rays, as distances do: Norm_sqr lets Newton's method
# alternate between touching and not.
LEVELS = {
    "plane": "(x - point) . Normalized(normal)",
    "sphere": "Norm(x - point) - radius",
    "ellipsoid": "(Norm((x - point) ./ half_sizes) - 1) * Norm(half_sizes) / sqrt(3)",
}


@dataclass(frozen=True)
class Touched:
    """An obstacle's multipliers (n,) in Pa at the nodes of a scalar field, and its data in a model.

    name: of the multipliers there. pressure: their improved values, in GetFEM's language. nodes:
    numbers of those on the faces. stiffness: Pa/m.
    """

    name: str
    field: getfem.MeshFem
    pressure: str
    nodes: np.ndarray
    stiffness: float
    multipliers: np.ndarray


class GetfemProblem(Problem):
    """Equilibrium of a HexMesh with the golden's element, assembled by GetFEM.

    A quadrature with its points at the nodes makes contact that of nodes, and the weight of an
    element, integrated at its centre, is shared equally by its nodes: both as in the golden.

    mesh: HexMesh. materials: list of Material. Raises InputError for a law that is not in LAWS, and
    for an obstacle that is not in LEVELS or gives way.
    """

    program = "GetFEM"

    def __init__(self, mesh, materials):
        corners = mesh.cells[:, LEXICOGRAPHIC]
        body = getfem.Mesh("empty", 3)
        body.add_convex(getfem.GeoTrans("GT_QK(3,1)"), mesh.points[corners].transpose(2, 1, 0))
        self._points = getfem.MeshIm(body, getfem.Integ("IM_GAUSS_PARALLELEPIPED(3,3)"))
        displacements = _field(body, 3, "FEM_QK(3,1)")
        self._dofs = np.empty(mesh.points.shape, dtype=np.int64)
        self._dofs[corners] = displacements.basic_dof_from_cvid()[0].reshape(len(corners), 8, 3)
        self._model = model = getfem.Model("real")
        model.add_fem_variable("u", displacements)
        model.add_fem_variable("pressure", _field(body, 1, "FEM_QK(3,0)"))
        model.add_initialized_data("load", 1.0)
        intervals = (model.interval_of_variable(name) for name in ("u", "pressure"))
        self._rows = [slice(first, first + size) for first, size in intervals]
        self._body, self._mesh, self._region = body, mesh, 0
        self._centres, self._vertices = (
            getfem.MeshIm(body, getfem.Integ(f"IM_{rule}_PARALLELEPIPED(3,1)"))
            for rule in ("GAUSS", "NC")
        )
        cells = _field(body, 1, "FEM_QK(3,0)")
        self._volumes, of_centres = (
            getfem.asm_generic(points, 1, "Test_q", -1, "q", True, cells, np.zeros(cells.nbdof()))
            for points in (self._points, self._centres)
        )
        model.add_initialized_fem_data("share", cells, self._volumes / of_centres)
        self._touched = []
        self._add_materials(materials)
        self._add_loads()
        self._add_obstacles(materials)
        self.displacement = Unknown(self._dofs.size)
        self.pressure = Unknown(len(corners))
        self.impose(mesh, self._dofs, self._dofs.size)
        self.symmetric = not any(s.pressure for s in mesh.surfaces)

    def _add_materials(self, materials):
        of_cell = self._mesh.materials
        for number, material in enumerate(materials):
            for known, name in (LAWS, material.law), (("quadratic",), material.volumetric):
                if name not in known:
                    raise InputError(f"there is no weak form of {name!r} for GetFEM")
            of_material = (
                np.full(len(self._mesh.cells), True) if of_cell is None else of_cell == number
            )
            cells = np.flatnonzero(of_material)
            slope, bulk = LAWS[material.law]
            values = "".join(f"Def {k} := {v!r}; " for k, v in material.parameters.items())
            where = np.stack([cells, np.full_like(cells, -1)])
            self._add(values + FORM.format(slope=slope, bulk=bulk).replace("\n", " "), where)
            if self._mesh.gravity:
                weight = material.density * self._mesh.acceleration()
                self._add(f"-load * share * {_text(weight)} . Test_u", where, self._centres)

    def _add_loads(self):
        for traction in self._mesh.tractions:
            x, y, z = traction.turn
            turn = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
            mean = traction.mean - turn @ traction.centre
            force = f"({_text(mean)} + {_text(turn.T)} * X)"
            self._add(f"-load * {force} . Test_u", self._faces(traction.nodes))
        for surface in self._mesh.surfaces:
            faces = self._faces(surface.nodes)
            if surface.pressure:
                turned = "(Det(Id(3) + Grad_u) * Inv(Id(3) + Grad_u') * Normal)"  # Nanson
                self._add(f"load * {surface.pressure!r} * {turned} . Test_u", faces)
            if surface.stiffness:
                moved = "((u . Normal) * Normal)" if surface.only_normal else "u"
                self._add(f"{surface.stiffness!r} * {moved} . Test_u", faces)

    def _add_obstacles(self, materials):
        """The augmented Lagrangian of each obstacle, with a multiplier at each node."""
        modulus = min(young_modulus(m.law, m.parameters) for m in materials)
        stiffness = LIMIT_PENALTY * modulus / self._volumes.min() ** (1 / 3)
        for number, touching in enumerate(self._mesh.touching):
            obstacle = touching.obstacle
            if obstacle.shape not in LEVELS or not obstacle.limit:
                raise InputError(
                    f"obstacle: shape {obstacle.shape!r} is not set up for GetFEM here, nor is a "
                    f"penalty; allowed: {', '.join(LEVELS)}, without penetration"
                )
            level = LEVELS[obstacle.shape]
            for key, value in obstacle.parameters.items():
                level = re.sub(rf"\b{key}\b", _text(value), level)
            place = f"(X + u - load * {_text(obstacle.displacement)})"
            level = re.sub(r"\bx\b", place, level)
            level = f"{-1 if obstacle.inside else 1} * ({level})"
            name = f"multiplier{number}"
            field = _field(self._body, 1, "FEM_QK(3,1)")
            self._model.add_initialized_fem_data(name, field, np.zeros(field.nbdof()))
            pressed = f"{name} - {stiffness!r} * {level}"
            self._add(
                f"half_sqr_pos_part({pressed}) / {stiffness!r}",
                self._faces(touching.nodes),
                self._vertices,
            )
            nodes = field.basic_dof_on_region(self._region)
            values = np.zeros(field.nbdof())
            self._touched.append(
                Touched(name, field, f"pos_part({pressed})", nodes, stiffness, values)
            )

    def multipliers(self):
        """See newton.Problem."""
        return [one.multipliers for one in self._touched]

    def augment(self):
        """See newton.Problem."""
        self._set()
        largest = 0.0
        for one in self._touched:
            pressure = self._model.interpolation(one.pressure, one.field)[one.nodes]
            change = np.abs(pressure - one.multipliers[one.nodes]).max() / one.stiffness
            largest = max(largest, change)
            one.multipliers[one.nodes] = pressure
        return largest

    def _add(self, expression, where, points=None):
        """A term of the weak form on cells or faces (2, k), as GetFEM has them.

        points: the quadrature; default: the golden's.
        """
        self._region += 1
        self._body.set_region(self._region, where)
        self._model.add_nonlinear_term(points or self._points, expression, self._region)

    def _faces(self, nodes):
        """(2, k) of the boundary faces within a set: cells, local faces. nodes: (n,) bool."""
        cells, faces = self._body.outer_faces()
        inside = nodes[self._mesh.cells[:, LEXICOGRAPHIC]]
        loaded = np.stack([inside[:, slots].all(axis=1) for slots in FACES], axis=1)
        kept = loaded[cells, faces]
        return np.stack([cells[kept], faces[kept]])

    def nodal_displacement(self):
        """Displacement (n, 3) in m at the nodes of the HexMesh."""
        return self.displacement.array[self._dofs]

    def _assemble(self, what):
        self._set()
        self._model.assembly(what)

    def _set(self):
        """Gives the model the unknowns, the load factor and the multipliers."""
        model = self._model
        model.set_variable("u", self.displacement.array)
        model.set_variable("pressure", self.pressure.array)
        model.set_variable("load", self.load)
        for one in self._touched:
            model.set_variable(one.name, one.multipliers)

    def mixed_residual(self):
        """Both rows of the mixed system: forces (N,) in N and (M,) in m^3; NaN where inverted."""
        self._assemble("build_rhs")
        return self._residual()

    def _residual(self):
        return tuple(-self._model.rhs()[rows] for rows in self._rows)

    def linearize(self):
        """See MixedProblem.linearize."""
        self._assemble("build_all")
        force, dilatation = self._residual()
        matrix = self._model.tangent_matrix()
        starts, rows = matrix.csc_ind()
        matrix = scipy.sparse.csc_matrix((matrix.csc_val(), rows, starts)).tocsr()
        blocks = [matrix[rows, columns] for rows in self._rows for columns in self._rows]
        return condensed(blocks, force, dilatation)


def _field(mesh, size, element):
    """The finite element space of vectors of a size on a mesh."""
    field = getfem.MeshFem(mesh, size)
    field.set_fem(getfem.Fem(element))
    return field


def _text(values):
    """Numbers, a vector or a matrix in GetFEM's language."""
    return str(np.asarray(values).tolist()).replace("], [", "],[")
