"""The answer of a body as arrays."""

import os

import numpy as np

import _sandglass
from sandglass.arguments import integer, number, path_text, real_array, text
from sandglass.gradient import Gradient


class Solution:
    """The answer of `Body.solve`. Arrays are read-only, in the numbering of the mesh, in SI units.

    A static answer has a frame for each load level of the search: the undeformed body first, the
    answer last. A motion has the frames that its `sg.Dynamics` asks for. Attributes without a frame
    are those of the last one.
    """

    def __init__(self, answer, name, laws):
        self._answer, self.name, self._laws = answer, name, laws
        points, cells, self.sets, self.element_sets = answer.mesh()
        self.points = _fixed(points)  #: (n, 3), m, undeformed; refined where the case refines
        self.cells = _fixed(cells)  #: (m, 8), VTK order
        self._frames = {}
        self.history = {key: _fixed(column) for key, column in answer.history().items()}
        """A dict of arrays (rows,): time in s (see `times`), energies in J, residual."""
        self.summary = dict(answer.summary())
        """How the answer was found: seconds, evaluations and residual and stability, or steps."""

    def __len__(self):
        return self._answer.frames

    def frame(self, number=-1):
        """A frame: a dict of time (s), displacement and velocity (n, 3; m, m/s), volume_ratio (m,),
        stress (m, 3, 3; Pa, Cauchy, mean of the element), hourglass_energy_density (m,; J/m^3),
        reactions, a dict from driven sets and obstacles to forces (3,; N), and moments, one from
        obstacles to moments (3,; N m) about their points. Negative numbers count from the end.
        Raises IndexError.
        """
        return self._frame("number", number)

    def _frame(self, argument, number):
        n, number = len(self), integer(argument, number)
        if not -n <= number < n:
            raise IndexError(f"{argument}: frame {number} must be in [{-n}, {n})")
        number = range(n)[number]
        if number not in self._frames:
            frame = self._answer.frame(number)
            self._frames[number] = {key: _fixed(value) for key, value in frame.items()}
        return self._frames[number]

    @property
    def times(self):
        """Times of the frames, s; (frames,).

        Of a static answer, load factors, which grow beyond 1 while the equilibrium is sought.
        """
        return _fixed(np.array([self.frame(k)["time"] for k in range(len(self))]))

    @property
    def displacements(self):
        """Displacements of all frames, m; (frames, n, 3)."""
        return _fixed(np.array([self.frame(k)["displacement"] for k in range(len(self))]))

    @property
    def displacement(self):
        """Displacements, m; (n, 3)."""
        return self.frame()["displacement"]

    @property
    def velocity(self):
        """Velocities, m/s; (n, 3)."""
        return self.frame()["velocity"]

    @property
    def stress(self):
        """Cauchy stresses, element means, Pa; (m, 3, 3). Raises InputError if there are none."""
        if "stress" not in self.frame():
            raise _sandglass.InputError("stress: the method computes no stresses")
        return self.frame()["stress"]

    @property
    def volume_ratio(self):
        """Deformed over undeformed volume of each element; (m,)."""
        return self.frame()["volume_ratio"]

    @property
    def reactions(self):
        """The forces that hold or drive sets of nodes, N; a dict from sets to arrays (3,)."""
        return self.frame()["reactions"]

    @property
    def energies(self):
        """The last energies of the history, J: kinetic, strain, hourglass, external_work."""
        names = ("kinetic", "strain", "hourglass", "external_work")
        return {name: float(self.history[name][-1]) for name in names}

    def estimate(self, against="golden"):
        """The estimated largest and rms distance of the displacements from a better answer, m.

        `against`: "golden", the mean-dilatation element on this mesh, or "truth", ever finer
        meshes. Raises InputError for a motion, and ComputationError.
        """
        return self._answer.estimate(text("against", against))

    def gradient(self, displacement=None, reactions=None, *, materials=True, points=False):
        """The derivatives of a scalar J of this answer by everything that J depends on.

        For a static answer: `displacement`: dJ/du, (n, 3). `reactions`: a dict from driven sets to
        dJ/dR, (3,). `points`: whether also by the undeformed positions of nodes, which takes
        longer. One adjoint problem for all parameters together, which costs about as much as
        `solve`. Dead loads and springs may act. Levels of adaptive elements count as constant.

        For a motion: `displacement`: dJ/du at all frames, (frames, n, 3). The steps are computed
        again and followed back, with their lengths: the result is the derivative of the computed
        motion at constant steps. Memory grows as the root of their number. `materials`: whether
        also by the parameters of laws, which takes half of the time or more.

        Returns an `sg.Gradient`. Raises InputError where the forces of elements have no potential
        (Updated Lagrangian methods), with obstacles or contact, in single precision; for static
        answers with pressures; for motions with viscoelastic laws, subcycles, tl-adaptive, and by
        reactions or points; ComputationError for a static answer that is not stable.
        """
        reactions = _weights({} if reactions is None else reactions)
        for name, value in {"materials": materials, "points": points}.items():
            if not isinstance(value, (bool, np.bool_)):
                raise TypeError(f"{name} must be True or False, but is a {type(value).__name__}")
        found = self._answer.gradient(displacement, reactions, materials, points)
        if materials:
            found["materials"] = self._laws.gathered(found["materials"])
        return Gradient(**{key: _fixed(value) for key, value in found.items()})

    def sensitivity(self, materials=None, *, forces=None, imposed=None):
        """The derivative of the displacements along one change of the arguments; (n, 3).

        `materials`: the changes of the parameters of each material, a list of dicts such as
        `[{"young_modulus": 1.0}, {}]`, or a dict for a body of one material; of a parameter that is
        an array, an array or a number. `forces`: those of forces on nodes, N, (n, 3). `imposed`:
        those of imposed displacements, m, (n, 3), of which components that are free do not count.
        One linear problem. Raises like `gradient`.
        """
        if materials is None:
            materials = []
        elif hasattr(materials, "items"):
            materials = [materials]
        materials = self._laws.spread(_changes(materials))
        return _fixed(self._answer.sensitivity(materials, forces, imposed))

    def to_vtk(self, frame=-1):
        """A `vtkUnstructuredGrid` of a frame, undeformed, with its arrays; for pyvista as it is."""
        from sandglass.vtk_grid import vtk_grid

        return vtk_grid(self.points, self.cells, self._frame("frame", frame))

    def plot(self, field="displacement", *, frame=-1, scale=1.0, ax=None):
        """A picture of the deformed body with matplotlib.

        `field`: an array of the frame, whose vectors show their length and whose stresses show von
        Mises'. `scale` multiplies displacements. `ax`: 3D axes, else those of a new figure.
        Returns the figure. Raises InputError for an unknown field.
        """
        from sandglass.picture import draw

        faces, arrays = self._answer.boundary(), self._frame("frame", frame)
        scale = number("scale", scale)
        return draw(self.points, self.cells, faces, arrays, text("field", field), scale, ax)

    def save(self, file):
        """Writes a result: .h5 (all frames, an .xdmf beside it), .vtu or .npz (the last frame)."""
        file = path_text("file", file)
        ending = os.path.splitext(file)[1]
        if ending == ".h5":
            self._answer.write(file, f"the Python module sandglass {_sandglass.__version__}")
            return
        if ending not in (".vtu", ".npz"):
            raise _sandglass.InputError(f"file = '{file}' must end in .h5, .vtu or .npz")
        partial = f"{file}.partial{ending}"
        if ending == ".vtu":
            from sandglass.vtk_grid import write_vtu

            write_vtu(self.to_vtk(), partial)
        else:
            arrays = {
                key: value
                for key, value in self.frame().items()
                if key not in ("reactions", "moments")
            }
            np.savez_compressed(partial, points=self.points, cells=self.cells, **arrays)
        os.replace(partial, file)

    def __repr__(self):
        largest = np.linalg.norm(self.displacement, axis=1).max()
        frames = f"{len(self)} frames"
        return f"<sg.Solution of {self.name}: {frames}, largest displacement {largest:.4g} m>"


def _weights(reactions):
    """A dict from driven sets to derivatives (3,). Raises TypeError and InputError."""
    if not hasattr(reactions, "items"):
        kind = type(reactions).__name__
        raise TypeError(f"reactions must be a dict from sets to arrays (3,), but is a {kind}")
    found = {}
    for name, weights in reactions.items():
        name = text("a name in reactions", name)
        weights = real_array(f"reactions: '{name}'", weights)
        if weights.shape != (3,):
            raise _sandglass.InputError(
                f"reactions: '{name}' must have the shape (3,), but has {weights.shape}"
            )
        found[name] = weights
    return found


def _changes(materials):
    """A list of dicts from parameters to numbers. Raises TypeError."""
    if not isinstance(materials, (list, tuple)):
        raise TypeError(f"materials must be a list of dicts, but is a {type(materials).__name__}")
    for m, change in enumerate(materials):
        if not hasattr(change, "items"):
            raise TypeError(f"materials[{m}] must be a dict, but is a {type(change).__name__}")
        for name, value in change.items():
            real_array(f"materials[{m}]: {text(f'a name in materials[{m}]', name)}", value)
    return materials


def _fixed(value):
    """An array, or the arrays of a dict, made read-only."""
    if isinstance(value, dict):
        return {key: _fixed(entry) for key, entry in value.items()}
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    return value
