"""The bodies that files of other programs hold: a bent block of 2 x 2 x 3 hexahedra in two
materials, and blocks of voxels.
"""

from dataclasses import dataclass

import numpy as np

from common.hexahedron import CUBE, FACES

LAYERS = (2, 2, 3)


@dataclass
class Body:
    """points, cells, sets of nodes and of elements: what a file must give."""

    points: np.ndarray
    cells: np.ndarray
    sets: dict
    element_sets: dict

    def faces(self, name):
        """(element, side) of the faces that lie in a set of nodes."""
        return np.argwhere(np.isin(self.cells[:, FACES], self.sets[name]).all(axis=2))

    def quads(self, name):
        """The nodes (n, 4) of those faces."""
        elements, sides = self.faces(name).T
        return self.cells[elements[:, None], FACES[sides]]

    def marks(self, kind):
        """(point arrays, cell arrays) of 0 and 1 that mark the sets."""
        nodes, cells = np.arange(len(self.points)), np.arange(len(self.cells))
        return [
            {name: np.isin(own, some).astype(kind) for name, some in sets.items()}
            for own, sets in ((nodes, self.sets), (cells, self.element_sets))
        ]


def lattice(at):
    """(whole-numbered points, cells) of the boxes whose lowest corners are at (n, 3)."""
    points, cells = np.unique((at[:, None] + CUBE).reshape(-1, 3), axis=0, return_inverse=True)
    return points, cells.reshape(-1, 8)


def bent_block():
    """The Body of most files, whose names every format can hold."""
    at, cells = lattice(np.argwhere(np.ones(LAYERS)))
    x, y, z = (at * (0.05, 0.05, 0.1)).T
    faces = {"foot": at[:, 2] == 0, "head": at[:, 2] == 3, "side": at[:, 0] == 0}
    layer = at[cells[:, 0], 2]
    return Body(
        np.column_stack([x + 0.8 * z * z, y - 0.3 * x * z, z + 0.2 * x]),
        cells,
        {name: np.flatnonzero(inside) for name, inside in faces.items()},
        {"stiff": np.flatnonzero(layer == 1), "soft": np.flatnonzero(layer != 1)},
    )


BODY = bent_block()
GROUPS = [(2, tag, name) for tag, name in enumerate(BODY.sets, 1)]
GROUPS += [(3, tag, name) for tag, name in enumerate(BODY.element_sets, 1)]


def with_nodes_of_elements(nodes={}, elements={}):
    """The body with other sets, where each set of elements is one of nodes, too."""
    elements = BODY.element_sets | elements
    own = {name: np.unique(BODY.cells[some]) for name, some in elements.items()}
    sets = BODY.sets | own | nodes
    if "Body-1.foot" in sets:
        sets["Assembly.foot"] = sets.pop("foot")
    return Body(BODY.points, BODY.cells, sets, elements)
