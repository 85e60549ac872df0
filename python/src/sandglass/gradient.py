"""The derivatives of a scalar of a static answer."""

import dataclasses

import numpy as np


@dataclasses.dataclass(frozen=True, eq=False)
class Gradient:
    """The derivatives of a scalar J of a static answer; see `Solution.gradient`.

    Units are that of J over the unit of the parameter. Everything else counts as constant.
    """

    materials: tuple
    """A dict for each material of the body, in their order: from the names of the parameters of its
    law, as `help(sg.NeoHookean)` lists them without the density, to derivatives."""

    stiffness: np.ndarray
    """By a factor of the stiffness of each element, its law and hourglass control, at 1; (m,)."""

    forces: np.ndarray
    """By a force on each node, 1/N; (n, 3). On components that are imposed, minus dJ/dR."""

    imposed: np.ndarray
    """By the imposed displacement of each node, 1/m; (n, 3). Zero on components that are free."""

    points: np.ndarray | None
    """By the undeformed position of each node, 1/m; (n, 3). The forces of loads on nodes, springs,
    imposed displacements and fibres count as constant. None without `points=True`."""

    def __repr__(self):
        return f"<sg.Gradient: materials {list(self.materials)}>"
