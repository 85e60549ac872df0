"""The golden's problem by a second program: SfePy's own Total Lagrangian mixed terms on our mesh.

Only Newton's method and the linear solver are the golden's; they affect the speed, not the answer.
Pressures have SfePy's sign, which is the opposite.
"""

import contextlib
import io
from pathlib import Path

import numpy as np
import scipy.sparse

with contextlib.redirect_stdout(io.StringIO()):
    # SfePy creates this folder on first import, and fails if another process does too.
    (Path.home() / ".sfepy").mkdir(exist_ok=True)
    import sfepy.discrete as discrete  # must come first: other orders of import fail
    from sfepy import __version__ as VERSION
    from sfepy.base.base import output
    from sfepy.discrete.fem import FEDomain, Field, Mesh
    from sfepy.terms import Term

from common.errors import InputError
from common.hexahedron import boundary_faces
from newton import Problem, Unknown, condensed

output.set_output(quiet=True)

# The degree of 2x2x2 Gauss points, as in the golden.
ORDER = 3
LAWS = ("neo-hookean",)


class SfepyProblem(Problem):
    """Equilibrium of a HexMesh, Q1 displacements and P0 pressures, with the terms of SfePy.

    mesh: HexMesh. materials: list of Material. Raises InputError if SfePy
    lacks an element or term.
    """

    program = f"SfePy {VERSION}"

    def __init__(self, mesh, materials):
        for material in materials:
            if material.law not in LAWS:
                raise InputError(f"SfePy has no term for the law {material.law!r}")
            if material.volumetric != "quadratic":
                raise InputError(f"SfePy has no {material.volumetric} volumetric term")
        if mesh.touching:
            raise InputError("obstacles are not set up for SfePy here")
        if mesh.gravity and not _has_parallelepipeds(mesh):
            raise InputError("SfePy integrates weight, which the golden's nodes share equally")
        self._mesh = mesh
        n_nodes, n_cells = len(mesh.points), len(mesh.cells)
        with contextlib.redirect_stdout(io.StringIO()):
            self._set_up(mesh, materials)
        self.displacement, self.pressure = Unknown(3 * n_nodes), Unknown(n_cells)
        self.impose(mesh, np.arange(3 * n_nodes).reshape(-1, 3), 3 * n_nodes)
        self.symmetric = not any(s.pressure for s in mesh.surfaces)

    def _set_up(self, mesh, materials):
        of_cell = np.zeros(len(mesh.cells), int) if mesh.materials is None else mesh.materials
        plain = Mesh.from_data(
            "body",
            mesh.points.copy(),
            None,
            [mesh.cells.astype(np.int32)],
            [np.zeros(len(of_cell), dtype=np.int32)],
            ["3_8"],
        )
        domain = FEDomain("domain", plain)
        body = domain.create_region("Omega", "all")
        fields = [
            Field.from_args("displacement", np.float64, "vector", body, approx_order=1),
            Field.from_args("pressure", np.float64, "scalar", body, approx_order=0),
        ]
        variable = discrete.FieldVariable
        u = variable("u", "unknown", fields[0])
        v = variable("v", "test", fields[0], primary_var_name="u")
        p = variable("p", "unknown", fields[1])
        q = variable("q", "test", fields[1], primary_var_name="p")
        volume = discrete.Integral("volume", order=ORDER)
        known = {"u": u, "v": v, "p": p, "q": q}

        def term(text):
            return Term.new(text, volume, body, **known)

        def of_material(value):
            """A number, or a vector, of each material at all points, cell by cell."""
            values = np.array([value(m) for m in materials]).reshape(len(materials), -1, 1)
            return lambda coors: np.repeat(values[of_cell], len(coors) // len(of_cell), axis=0)

        def bulk(m):
            return m.parameters["young_modulus"] / 3 / (1 - 2 * m.parameters["poisson_ratio"])

        def shear(m):
            return m.parameters["young_modulus"] / 2 / (1 + m.parameters["poisson_ratio"])

        self._factor = [1.0]  # of the loads
        known |= {
            "shear": self._material("shear", of_material(shear), scaled=False),
            "compliance": self._material(
                "compliance", of_material(lambda m: 1 / bulk(m)), scaled=False
            ),
            "weight": self._material(
                "weight", of_material(lambda m: m.density * mesh.acceleration())
            ),
        }
        balance = term("dw_tl_he_neohook(shear.val, v, u)") + term("dw_tl_bulk_pressure(v, u, p)")
        if mesh.gravity:
            balance = balance - term("dw_volume_lvf(weight.val, v)")
        # The integrals of q J, q and q p / K.
        dilatation = term("dw_tl_volume(q, u)") - term("dw_integrate(q)")
        dilatation = dilatation + term("dw_dot(compliance.val, q, p)")
        for number, load in enumerate((*mesh.tractions, *mesh.surfaces)):
            region = self._faces(f"face{number}", load.nodes, domain)
            balance = balance + self._load(load, region, known)
        equations = discrete.Equations(
            [discrete.Equation("balance", balance), discrete.Equation("dilatation", dilatation)]
        )
        problem = discrete.Problem("golden", equations=equations)
        problem.time_update()
        problem.update_materials()
        self._evaluator = problem.get_evaluator()
        self._problem = problem

    def _faces(self, name, nodes, domain):
        """The region of the boundary faces within a set. nodes: (n,) bool."""
        numbers = ", ".join(map(str, np.flatnonzero(nodes)))
        region = domain.create_region(name, f"vertex {numbers}", "facet")
        faces = boundary_faces(self._mesh.cells)
        if len(region.entities[2]) != nodes[faces].all(axis=1).sum():
            raise InputError(f"{name}: SfePy finds other faces in its set of nodes")
        return region

    def _load(self, load, region, known):
        """The term of a Traction, or of a Surface with a pressure or with springs, on its faces."""
        name = "of_" + region.name
        text, scaled = f"dw_surface_ltr({name}.val, v)", True
        if hasattr(load, "mean"):

            def value(coors):
                t = load.mean + np.cross(load.turn, coors - load.centre)
                return -t[:, :, None]

        elif load.only_normal:
            raise InputError("springs along the normal are not set up for SfePy here")
        elif load.pressure:
            text = f"dw_tl_surface_traction({name}.val, v, u)"

            def value(coors):
                return np.tile(load.pressure * np.eye(3), (len(coors), 1, 1))

        else:
            text, scaled = f"dw_dot({name}.val, v, u)", False

            def value(coors):
                return np.full((len(coors), 1, 1), load.stiffness)

        material = self._material(name, value, scaled)
        surface = discrete.Integral("surface", order=ORDER)
        return Term.new(text, surface, region, v=known["v"], u=known["u"], **{name: material})

    def _material(self, name, value, scaled=True):
        """SfePy's Material whose `val` is value(coordinates), times the load factor if scaled."""

        def at_points(_, coors, mode=None, **__):
            factor = self._factor[0] if scaled else 1.0
            return {"val": factor * value(coors)} if mode == "qp" else None

        return discrete.Material(name, function=discrete.Function(name, at_points))

    def nodal_displacement(self):
        """Displacement (n, 3) in m at the nodes of the HexMesh."""
        return self.displacement.array.reshape(-1, 3)

    def mixed_residual(self):
        """Both rows of the mixed system: forces (N,) in N and (M,) in m^3; NaN where inverted."""
        if self._factor[0] != self.load:
            self._factor[0] = self.load
            self._problem.update_materials()
        both = np.concatenate([self.displacement.array, self.pressure.array])
        n = len(self.displacement.array)
        try:
            residual = self._evaluator.eval_residual(both)
        except ValueError:  # an element is inverted, as SfePy reports on standard error
            residual = np.full(len(both), np.nan)
        return residual[:n], residual[n:]

    def linearize(self):
        """See MixedProblem.linearize."""
        force, dilatation = self.mixed_residual()
        both = np.concatenate([self.displacement.array, self.pressure.array])
        n = len(self.displacement.array)
        matrix = self._evaluator.eval_tangent_matrix(both).tocsr()
        uu, up, pu, pp = matrix[:n, :n], matrix[:n, n:], matrix[n:, :n], matrix[n:, n:]
        assert abs(pp - scipy.sparse.diags(pp.diagonal())).max() == 0, "pressure is not local"
        return condensed((uu, up, pu, pp), force, dilatation)


def _has_parallelepipeds(mesh):
    """Whether opposite edges of each cell of a HexMesh are equal."""
    corners = mesh.points[mesh.cells]
    edges = corners[:, [1, 2, 5, 6]] - corners[:, [0, 3, 4, 7]]  # along xi
    others = corners[:, [3, 7]] - corners[:, [0, 4]]
    bent = max(np.ptp(edges, axis=1).max(), np.ptp(others, axis=1).max())
    return bent <= 1e-9 * np.ptp(mesh.points)
