"""Dirichlet conditions for any Lagrange order: the trace of the Q1 displacement of the mesh.

If all vertices of an edge, face or cell (or the vertex itself) are in the set of a condition, all
its degrees of freedom are prescribed, with the mean of the vertices' values (the Q1 interpolation
at mid-edge, mid-face and centre). On exactly these entities the Q1 displacement is fully
prescribed, so Q1 and Q2 solve the same boundary value problem.
"""

import basix
import numpy as np


def prescribed_dofs(space, cell_nodes, conditions, load=1.0):
    """Prescribed degrees of freedom of a vector Lagrange space of order 1 or 2 on hexahedra.

    space: dolfinx vector function space. cell_nodes: (m, 8) node numbers, in the space's order of
    cells and vertices. conditions: Conditions on these nodes, which must not contradict each other.
    load: the load factor. Returns (dofs, values): sorted unrolled indices (3 * block + component)
    and their values, m.
    """
    layout = space.dofmap.dof_layout
    cell_dofs = space.dofmap.list.array.reshape(len(cell_nodes), -1)
    dofs, values = [np.empty(0, dtype=int)], [np.empty(0)]
    for condition in conditions:
        on_nodes = condition.at(load)
        for dim, entities in enumerate(basix.topology(basix.CellType.hexahedron)):
            for index, vertices in enumerate(entities):
                nodes = cell_nodes[:, vertices]
                inside = condition.nodes[nodes].all(axis=1)
                mean = on_nodes[nodes[inside]].mean(axis=1)
                for local in layout.entity_dofs(dim, index):
                    for axis in condition.components:
                        dofs.append(3 * cell_dofs[inside, local] + axis)
                        values.append(mean[:, axis])
    dofs, first = np.unique(np.concatenate(dofs), return_index=True)
    return dofs.astype(np.int32), np.concatenate(values)[first]
