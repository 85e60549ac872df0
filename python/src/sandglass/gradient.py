"""The derivatives of a scalar of an answer."""


class Gradient:
    """The derivatives of a scalar J of an answer, from `Solution.gradient`.

    Units are that of J over the unit of the parameter. Arrays are read-only.
    """

    def __init__(
        self, materials, stiffness, forces, imposed, points, velocities=None, damping=None
    ):
        self.materials = materials
        """A dict for each material of the body, in their order: from the parameters of its law, as
        `help(sg.NeoHookean)` lists them, to derivatives; without the density. By a parameter that
        is an array, one number for each of its elements, an array. None with `materials=False`."""
        self.stiffness = stiffness
        """By a factor, at 1, of the stiffness of each element: law and hourglass control; (m,)."""
        self.forces = forces
        """By a force on each node, 1/N; (n, 3). Of imposed components: minus dJ/dR. In a motion it
        grows with the load of the case, as an `sg.Force` without a curve of its own."""
        self.imposed = imposed
        """By the imposed displacement of each node, 1/m; (n, 3). Zero on free components."""
        self.points = points
        """By the undeformed position of each node, 1/m; (n, 3): weights, areas and the arms of
        rotations change, too; fibres count as constant. None without `points=True`."""
        self.velocities = velocities
        """By the initial velocity of each node, s/m; (n, 3). None for a static answer."""
        self.damping = damping
        """By the damping of `sg.Dynamics`, s. None for a static answer."""

    def __repr__(self):
        return f"<sg.Gradient: materials {list(self.materials or ())}>"
