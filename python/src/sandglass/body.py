"""A body: mesh, material and what acts on it, which can be solved, stepped, saved and read."""

import os
import tomllib

import _sandglass
from sandglass.arguments import path_text, quantity_text
from sandglass.batch import Batch
from sandglass.element_laws import ElementLaws
from sandglass.mesh import Mesh, _named, mesh_of_case
from sandglass.progress import shown
from sandglass.solution import Solution
from sandglass.tables import Table, class_for, plain
from sandglass.toml_text import toml_text

# The tables of a case that arguments of Body other than `tables` stand for.
_OTHER = ("case", "mesh", "material", "materials", "sets", "element_sets")


class Body:
    """A body in a case: what `sandglass run` computes, made in Python.

    `mesh`: an `sg.Mesh`, a generator such as `sg.Box`, the path of a mesh file, or an object of
    meshio or VTK. `material`: a law such as `sg.NeoHookean`, or several that name their `elements`;
    a number of a law may differ from element to element, as an array with a number for each of its
    elements, in the order of the set. `tables`: loads, imposed motions and settings, such as
    `sg.Displacement` and `sg.Pressure`; with `sg.Dynamics` the answer is a motion, else static
    equilibrium. `sets`: a dict from names to arrays of nodes, or to rules such as `{"z": [0, 0]}`;
    `element_sets` likewise for elements. All attributes may be changed; the mesh itself may not.

    `repr(body)` is its case file: `sg.Body.read` reads it, and so does `sandglass run`. Raises
    TypeError for arguments of another type, and InputError, with the solver's message, for
    wrong meshes; values of other tables are checked by `solve` and `simulation`.
    """

    def __init__(
        self,
        mesh,
        material,
        tables=(),
        *,
        sets=None,
        element_sets=None,
        name="body",
        requirement="computed from Python",
    ):
        arrays, self.sets = _split("sets", sets)
        more, self.element_sets = _split("element_sets", element_sets)
        self.mesh = Mesh.of(mesh)
        if arrays or more:
            own = self.mesh
            self.mesh = Mesh(own.points, own.cells, own.sets | arrays, own._as_given | more)
        self.material = material
        self.tables = list(tables) if _is_list(tables) else tables
        self.name = plain("name", name)
        self.requirement = plain("requirement", requirement)
        self._extra = {}  # tables of a case that nothing here reads
        self._case_tables()

    @classmethod
    def read(cls, file):
        """The body of a case file without [[variants]]. Raises InputError."""
        file = path_text("file", file)
        try:
            with open(file, "rb") as stream:
                case = tomllib.load(stream)
        except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise _sandglass.InputError(f"{file}: {error}") from None
        return cls._of_case(case, file, os.path.dirname(os.path.abspath(file)))

    @classmethod
    def of_toml(cls, text, mesh=None):
        """The body of the text of a case; `mesh` stands for its table [mesh]. Raises InputError."""
        try:
            case = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise _sandglass.InputError(f"text: {error}") from None
        return cls._of_case(case, "text", os.getcwd(), mesh)

    @classmethod
    def _of_case(cls, case, file, folder, mesh=None):
        if "variants" in case:
            raise _sandglass.InputError(f"{file}: [variants] make several cases; it must be one")
        try:
            body = cls.__new__(cls)
            head = case["case"]
            body.name, body.requirement = head["name"], head["requirement"]
            body.mesh = mesh_of_case(_in_folder(case["mesh"], folder)) if mesh is None else mesh
            body.mesh = Mesh.of(body.mesh)
            several = "materials" in case
            laws = case["materials"] if several else [case["material"]]
            laws = [_read_material(law, folder) for law in laws]
            body.material = laws if several else laws[0]
            body.sets, body.element_sets = case.get("sets", {}), case.get("element_sets", {})
            body.tables, body._extra = [], {}
            for name, table in case.items():
                if name in _OTHER:
                    continue
                if class_for(name) is None:
                    body._extra[name] = _references_in(name, table, folder)
                    continue
                for each in table if isinstance(table, list) else [table]:
                    body.tables.append(class_for(name)(**each))
            static = not any(t._declared["table"] == "dynamics" for t in body.tables)
            if head["answer"] != ("quasi-static" if static else "dynamic"):
                raise _sandglass.InputError(
                    "case.answer is dynamic with [dynamics], else quasi-static"
                )
        except KeyError as error:
            raise _sandglass.InputError(f"{file}: {error.args[0]} is missing") from None
        except _sandglass.InputError as error:
            raise _sandglass.InputError(f"{file}: {error}") from None
        except (TypeError, AttributeError) as error:
            raise _sandglass.InputError(f"{file}: {error}") from None
        return body

    def solve(self, *, threads=1, device="cpu", progress=None, sleep=None, against=None, **method):
        """The answer of the case: its static equilibrium, or its motion.

        `threads` do not change the answer. `device`: the processor that computes the forces of
        elements, such as "opencl" (as `sandglass run --device`). `progress=True` shows how far it
        is; a callable gets the completed share of the work now and then. `sleep`: leave out
        elements that would move by less than this share of the largest imposed displacement, such
        as 0.001 or "0.1%".
        `against="truth"`: the mesh is refined until the mean-dilatation element's answer, the
        default method then, is within the share `accuracy` of the exact one; `summary["error"]` of
        the solution is the distance of the answer from it. Other keywords replace those of the
        body's `sg.Method`: `name`, `kappa`, `precision`, `accuracy`, `kappa_modulus`. Other threads
        run meanwhile, and Ctrl-C ends it. Returns an `sg.Solution`. Raises InputError, and
        ComputationError if the computation fails.
        """
        accuracy = None
        if against is not None:
            if not isinstance(against, str) or against != "truth":
                raise _sandglass.InputError(f"against = {against!r} must be 'truth' or None")
            accuracy = method.pop("accuracy", None)
            if accuracy is None:
                raise _sandglass.InputError(
                    "against: needs accuracy, the largest allowed error, such as accuracy='2%'"
                )
            accuracy = quantity_text("accuracy", accuracy)
        elif isinstance(method.get("accuracy"), str):
            method["accuracy"] = _sandglass.share("accuracy", method["accuracy"])
        given = {
            "threads": threads,
            "device": device,
            "sleep": None if sleep is None else quantity_text("sleep", sleep),
            "accuracy": accuracy,
        }
        text = toml_text(self._case_tables(**method))
        with shown(progress, "solve") as callback:
            answer = _sandglass.solve(*self._mesh(), text, given, callback)
        return Solution(answer, self.name, self._element_laws())

    def simulation(
        self,
        *,
        precision="double",
        method=None,
        kappa=None,
        damping=None,
        step_fraction=None,
        threads=1,
        device="cpu",
    ):
        """An `sg.Simulation` of the body, to move and advance, with its keywords."""
        settings = {"precision": precision, "method": method, "kappa": kappa, "damping": damping}
        settings |= {"step_fraction": step_fraction, "threads": threads, "device": device}
        points, cells, sets, element_sets = self._mesh()
        text = toml_text(self._case_tables())
        return _sandglass.Simulation.of_mesh(
            points, cells, sets, text, element_sets=element_sets, **settings
        )

    def batch(
        self,
        bodies,
        *,
        precision="double",
        method=None,
        kappa=None,
        damping=None,
        step_fraction=None,
        threads=1,
    ):
        """An `sg.Batch` of this number of bodies, which move side by side and each in its own way.

        They are undeformed, at rest or with the case's initial velocities. Keywords are those of
        `sg.Simulation`. Raises InputError for what a batch does not support: other laws than
        isotropic elastic ones, other forces than dead ones, ties, and methods without kernels for
        batches, whose message lists those with them.
        """
        given = {"bodies": bodies, "precision": precision, "method": method, "kappa": kappa}
        given |= {"damping": damping, "step_fraction": step_fraction, "threads": threads}
        text = toml_text(self._case_tables())
        return Batch(_sandglass.Batch(*self._mesh(), text, given), bodies, self._element_laws())

    def save(self, file):
        """Writes the case file and, unless a generator or a file makes the mesh, its .h5."""
        file = path_text("file", file)
        mesh_file = os.path.splitext(file)[0] + ".h5"
        if self._mesh_with_laws()._table is None:
            self._mesh_with_laws().save(mesh_file)
        text = toml_text(
            self._case_tables() | {"mesh": self._mesh_table(os.path.basename(mesh_file))}
        )
        with open(file + ".partial", "w", encoding="utf-8") as stream:
            stream.write(text)
        os.replace(file + ".partial", file)

    def __repr__(self):
        return toml_text(self._case_tables() | {"mesh": self._mesh_table(f"{self.name}.h5")})

    def _mesh_table(self, file):
        return self._mesh_with_laws()._table or {"file": file}

    def _mesh(self):
        mesh = self._mesh_with_laws()
        return mesh.points, mesh.cells, mesh.sets, mesh.element_sets

    def _mesh_with_laws(self):
        """The mesh, with the sets of laws that differ from element to element."""
        new = self._element_laws().element_sets
        own = self.mesh
        return Mesh(own.points, own.cells, own.sets, own._as_given | new) if new else own

    def _element_laws(self):
        materials = self.material if _is_list(self.material) else [self.material]
        for each in materials:
            _require_table("material", each, ("material",))
        if not isinstance(self.mesh, Mesh):
            raise TypeError(f"mesh must be a sg.Mesh, but is a {type(self.mesh).__name__}")
        return ElementLaws(materials, self.mesh)

    def _case_tables(self, **method):
        """The tables of the case but [mesh]; `method` replaces keys of [method]."""
        laws = self._element_laws().laws
        if not _is_list(self.tables):
            raise TypeError(f"tables must be a list, but is a {type(self.tables).__name__}")
        for each in self.tables:
            _require_table("tables", each, None)
        present = {each._declared["table"] for each in self.tables}
        answer = "dynamic" if "dynamics" in present else "quasi-static"
        case = {"name": self.name, "requirement": self.requirement, "answer": answer}
        found = {"case": case}
        if _is_list(self.material) or len(laws) > 1:
            found["materials"] = [each._toml() for each in laws]
        else:
            found["material"] = laws[0]._toml()
        for kind in ("sets", "element_sets"):
            rules = plain(kind, getattr(self, kind))
            if rules:
                found[kind] = rules
        for each in self.tables:
            name = each._declared["table"]
            if each._declared["several"]:
                found.setdefault(name, []).append(each._toml())
            elif name in found:
                raise _sandglass.InputError(
                    f"tables: {each._name()} is given twice; it must be one"
                )
            else:
                found[name] = each._toml()
        if method:
            cls = class_for("method")
            base = found.get("method", {"name": "tl-perturbation"})
            given = cls(**({"name": base["name"]} | method))._toml()
            if given["name"] != base["name"]:  # kappa and the like are the other's
                base = {key: base[key] for key in base if key == "precision"}
            found["method"] = {key: base[key] for key in base if key not in method} | given
        return found | self._extra


def _is_list(value):
    return isinstance(value, (list, tuple))


def _require_table(argument, value, allowed):
    """Raises TypeError unless a value is an allowed table; None: any but mesh and material."""
    name = value._declared["table"] if isinstance(value, Table) and value._declared else None
    if name is None or (name not in allowed if allowed else name in _OTHER):
        what = "a law such as sg.NeoHookean" if allowed else "tables such as sg.Displacement"
        found = value._name() if name else f"a {type(value).__name__}"
        raise TypeError(f"{argument} must be {what}, but is {found}")


def _split(argument, sets):
    """Arrays of members, and rules, of a dict with both."""
    sets = _named(argument, sets)
    rules = {name: rule for name, rule in sets.items() if hasattr(rule, "items")}
    plain(argument, rules)
    return {name: sets[name] for name in sets if name not in rules}, rules


def _in_folder(table, folder):
    """A table whose `file` is relative to the current folder."""
    if "file" not in table:
        return table
    return table | {"file": os.path.join(folder, table["file"])}


def _references_in(name, table, folder):
    """A table of which the files of a [comparison] are relative to the current folder."""
    if name != "comparison":
        return table
    files = {key: os.path.join(folder, table[key]) for key in ("golden", "truth") if key in table}
    return table | files


def _read_material(table, folder):
    table = dict(table)
    if "fibres" in table:
        table["fibres"] = _in_folder(table["fibres"], folder)
    law = table.pop("law")
    cls = class_for("material", law)
    if cls is None:
        raise _sandglass.InputError(f"material.law = '{law}' is not known")
    return cls(**table)
