"""Many bodies of one case that move side by side."""

import numpy as np

import _sandglass
from sandglass.arguments import integer, number, real_array, text


class Batch:
    """Many bodies of one case that move side by side, from `Body.batch`.

    They share mesh, kinds of laws, densities, method, damping and step; each has its own stiffness,
    parameters of laws, driven nodes and load factor, which are arrays with a row for each body.
    Results equal those of an `sg.Simulation` of each body up to rounding: sums have another order.
    A single number may replace any array (bodies,). Raises InputError and
    TypeError, and ComputationError, which names the body, if elements are inverted.
    """

    def __init__(self, batch, bodies, laws):
        self._batch, self._laws = batch, laws
        self.bodies = bodies  #: their number

    def __len__(self):
        return self.bodies

    def scale_stiffness(self, factors):
        """Multiplies all moduli of the case by a positive factor for each body, (bodies,)."""
        self._batch.scale_stiffness(self._positive("factors", factors))

    def set_parameters(self, materials):
        """Parameters of the laws of each body, in place of the case's. The step adapts.

        A dict for each material of the body, in their order, or one dict for a body of one
        material: from parameters, as `help(sg.NeoHookean)` lists them, to arrays (bodies,), or
        (bodies, elements) where the law of the case has an array for its elements. Others stay as
        they are. Raises InputError that names material, body, value and rule.
        """
        materials = [materials] if hasattr(materials, "items") else materials
        if not isinstance(materials, (list, tuple)):
            kind = type(materials).__name__
            raise TypeError(f"materials must be a list of dicts, but is a {kind}")
        given = [self._parameters(m, each) for m, each in enumerate(materials)]
        self._batch.set_parameters(self._laws.of_bodies(given))

    def impose(self, factors):
        """Loads and imposed displacements at a load factor of each body, (bodies,).

        Before the first call there are none. They are reached at the end of the next `advance`; see
        `Simulation.impose`.
        """
        self._batch.impose(self._numbers("factors", factors))

    def move(self, set, displacements):
        """Targets of the driven nodes of a set at the end of the next `advance`, m.

        (3,) for all bodies, (bodies, 3), or (bodies, nodes of the set, 3).
        """
        given, set = real_array("displacements", displacements), text("set", set)
        if given.shape == (3,):
            given = np.tile(given, (self.bodies, 1))
        shapes = [(self.bodies, 3), (self.bodies, len(self.nodes(set)), 3)]
        if given.shape not in shapes:
            _refuse_shape("displacements", ["(3,)", *map(str, shapes)], given)
        self._batch.move(set, given)

    def advance(self, seconds):
        """Advances all bodies; driven nodes and forces change linearly. Other threads run.

        Checks for inverted elements and NaN every `check_interval` steps (of `sg.Dynamics`).
        """
        self._batch.advance(number("seconds", seconds))

    def run(self, seconds, frames, *, stiffness=None, materials=None, factors=None, driven=None):
        """Moves all bodies through a number of equal frames; returns displacements, m.

        `stiffness`: factors of all moduli, (bodies,). `materials`: parameters of laws, arrays
        (bodies,); see `set_parameters`. `factors`: load factors, (bodies,), which are
        reached linearly at the end, or (bodies, frames), at the end of each frame; they scale loads
        and imposed displacements and rotations, which without them are zero, except loads with a
        curve of their own (`times`, `formula`), which follow it. `driven`: a dict from driven sets
        to targets at the end of each frame, (bodies, frames, 3) or (bodies, frames, nodes of the
        set, 3), m.

        Returns an array (bodies, frames, n, 3), in the numbering of the mesh.
        """
        frames, seconds = integer("frames", frames), number("seconds", seconds)
        if not 1 <= frames < 2**31:
            raise _sandglass.InputError(f"frames = {frames} must be in [1, 2^31)")
        if not hasattr({} if driven is None else driven, "items"):
            raise TypeError(f"driven must be a dict, but is a {type(driven).__name__}")
        targets = {name: self._targets(name, rows, frames) for name, rows in (driven or {}).items()}
        course = None if factors is None else self._course(factors, frames)
        if materials is not None:
            self.set_parameters(materials)
        if stiffness is not None:
            self._batch.scale_stiffness(self._positive("stiffness", stiffness))
        found = []
        for frame in range(frames):
            if course is not None:
                self._batch.impose(np.ascontiguousarray(course[:, frame]))
            for name, rows in targets.items():
                self._batch.move(name, np.ascontiguousarray(rows[:, frame]))
            self._batch.advance(seconds / frames)
            found.append(self._batch.displacements())
        return np.stack(found, axis=1)

    @property
    def displacements(self):
        """Displacements, m, in the numbering of the mesh; (bodies, n, 3). A copy."""
        return self._batch.displacements()

    def reaction(self, set):
        """The forces that hold or drive a set of nodes, N; (bodies, 3)."""
        return self._batch.reactions(text("set", set))

    def nodes(self, set):
        """The nodes of a set, sorted."""
        return self._batch.nodes(text("set", set))

    @property
    def time(self):
        """The simulated time, s."""
        return self._batch.time

    @property
    def step_size(self):
        """The longest step allowed at present, s: that of the stiffest body."""
        return self._batch.step_size

    def __repr__(self):
        return f"<sg.Batch: {self.bodies} bodies at {self.time:.4g} s>"

    def _numbers(self, name, given):
        numbers = real_array(name, given)
        if numbers.shape == ():
            numbers = np.full(self.bodies, float(numbers))
        if numbers.shape != (self.bodies,):
            _refuse_shape(name, [f"({self.bodies},)"], numbers)
        return numbers

    def _parameters(self, m, given):
        """The parameters of a material, arrays (bodies,) or (bodies, its elements)."""
        if not hasattr(given, "items"):
            raise TypeError(f"materials[{m}] must be a dict, but is a {type(given).__name__}")
        found = {}
        for name, values in given.items():
            title = f"materials[{m}]: {text(f'a name in materials[{m}]', name)}"
            values = real_array(title, values)
            shape = self._laws.shape(m, name)
            if values.ndim < 2 or values.shape != (self.bodies, *shape):
                values = self._numbers(title, values)
            found[name] = values
        return found

    def _positive(self, name, given):
        numbers = self._numbers(name, given)
        if not (numbers > 0).all():
            raise _sandglass.InputError(f"{name} must be positive, but has {numbers.min()}")
        return numbers

    def _course(self, factors, frames):
        """Load factors at the ends of frames, (bodies, frames)."""
        given = real_array("factors", factors)
        if given.shape == (self.bodies, frames) and given.ndim == 2:
            return given
        if given.shape not in ((), (self.bodies,)):
            _refuse_shape("factors", [f"({self.bodies},)", f"({self.bodies}, {frames})"], given)
        return self._numbers("factors", given)[:, None] * np.arange(1, frames + 1) / frames

    def _targets(self, name, rows, frames):
        given = real_array(f"driven: '{name}'", rows)
        allowed = [(self.bodies, frames, 3), (self.bodies, frames, len(self.nodes(name)), 3)]
        if given.shape not in allowed:
            _refuse_shape(f"driven: '{name}'", map(str, allowed), given)
        return given


def _refuse_shape(name, shapes, array):
    allowed = " or ".join(shapes)
    raise _sandglass.InputError(f"{name} must have the shape {allowed}, but has {array.shape}")
