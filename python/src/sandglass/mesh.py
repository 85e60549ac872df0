"""Meshes from arrays, files, generators, meshio and VTK."""

import os

import numpy as np

import _sandglass
from sandglass.arguments import path_text, real_array
from sandglass.tables import Table, class_for
from sandglass.toml_text import keys_text

# The nodes of VTK's voxel, whose numbers count along x, then y, then z, in the order of a
# hexahedron.
_VOXEL = [0, 1, 3, 2, 4, 5, 7, 6]
_HEXAHEDRON_TYPE, _VOXEL_TYPE = 12, 11  # of VTK


class Mesh:
    """Hexahedra in memory, with named sets of nodes and of elements.

    `points`: (n, 3) in m. `cells`: (m, 8) integers, the nodes of each hexahedron in VTK order,
    counted from 0. `sets`, `element_sets`: dicts from names to arrays of nodes, or of elements, or
    to masks: arrays of bool with an entry for each node, or element.
    Raises TypeError for arrays of another type and InputError for other shapes, unknown nodes,
    nodes without cell and points that are not finite.
    """

    def __init__(self, points, cells, sets=None, element_sets=None):
        given = _without_masks(_named("element_sets", element_sets), cells)
        points, cells, sets, element_sets = _sandglass.checked_mesh(
            points, cells, _without_masks(_named("sets", sets), points), given
        )
        self._set(points, cells, sets, element_sets)
        for name, elements in element_sets.items():
            if np.size(given[name]) == elements.size:  # none repeated
                self._as_given[name] = np.array(given[name]).ravel()

    def _set(self, points, cells, sets, element_sets):
        self.points = points  #: (n, 3), m
        self.cells = cells  #: (m, 8)
        self.sets = sets  #: nodes, by the names of sets
        self.element_sets = element_sets  #: elements, by the names of sets, sorted
        self._as_given = dict(element_sets)  # in the order of numbers of laws
        self._table = None  # the table [mesh] of a case with this mesh
        for array in (points, cells, *sets.values(), *element_sets.values()):
            array.flags.writeable = False

    @classmethod
    def read(cls, file, spacing=None):
        """The mesh of a file: .h5, .msh, .inp, .vtu, or a labelled image, .npy or .nii.

        `spacing`: (3,), the size of a voxel in m, of an image without one. Raises InputError.
        """
        table = {"file": path_text("file", file)}
        if spacing is not None:
            table["spacing"] = real_array("spacing", spacing).tolist()
        return cls._of_keys(table)

    @classmethod
    def of(cls, mesh):
        """A mesh of a Mesh, a generator such as `sg.Box`, a path, or an object of meshio or VTK.

        Raises TypeError for anything else, and InputError.
        """
        if isinstance(mesh, Mesh):
            return mesh
        if isinstance(mesh, Table):
            if mesh._declared["table"] != "mesh":
                raise TypeError(f"mesh must be a mesh or a generator, but is a {mesh._name()}")
            return cls._of_keys(mesh._toml())
        if isinstance(mesh, (str, os.PathLike)):
            return cls.read(path_text("mesh", mesh))
        if hasattr(mesh, "cells_dict"):
            return cls.of_meshio(mesh)
        if hasattr(mesh, "GetCellTypesArray"):
            return cls.of_vtk(mesh)
        raise TypeError(
            "mesh must be a sg.Mesh, a generator such as sg.Box, a path, a meshio.Mesh or a "
            f"vtkUnstructuredGrid, but is a {type(mesh).__name__}"
        )

    @classmethod
    def _of_keys(cls, table):
        mesh = cls.__new__(cls)
        mesh._set(*_sandglass.mesh_of_keys(keys_text(table)))
        if "file" in table:
            table = table | {"file": os.path.abspath(table["file"])}
        mesh._table = table
        return mesh

    @classmethod
    def of_meshio(cls, mesh):
        """The hexahedra of a `meshio.Mesh`; nodes of no hexahedron are left out.

        Its point_sets and cell_sets are sets; Gmsh's physical groups too: of hexahedra sets of
        elements, and all of them sets of nodes. Raises InputError for a mesh without hexahedra.
        """
        if not hasattr(mesh, "cells_dict"):
            raise TypeError(f"mesh must be a meshio.Mesh, but is a {type(mesh).__name__}")
        blocks = [k for k, block in enumerate(mesh.cells) if block.type == "hexahedron"]
        if not blocks:
            found = ", ".join(sorted({block.type for block in mesh.cells})) or "no cells"
            raise _sandglass.InputError(f"mesh has no hexahedra, but {found}")
        starts = np.cumsum([0] + [len(mesh.cells[k].data) for k in blocks])
        first = dict(zip(blocks, starts))
        sets = {name: np.asarray(nodes) for name, nodes in mesh.point_sets.items()}
        element_sets = {}

        def add(kind, name, members):
            kind[name] = np.concatenate([kind.get(name, np.zeros(0, int)), members])

        for name, parts in mesh.cell_sets.items():
            for k in blocks:
                if parts[k] is not None and len(parts[k]):
                    add(element_sets, name, first[k] + np.asarray(parts[k], int))
        tags = mesh.cell_data.get("gmsh:physical")
        for name, (tag, _) in mesh.field_data.items() if tags is not None else ():
            for k, block in enumerate(mesh.cells):
                chosen = np.flatnonzero(np.asarray(tags[k]) == tag)
                if len(chosen):
                    add(sets, name, np.unique(block.data[chosen]))
                    if k in first:
                        add(element_sets, name, first[k] + chosen)
        cells = np.concatenate([mesh.cells[k].data for k in blocks])
        return cls._of_used(mesh.points, cells, sets, element_sets)

    @classmethod
    def of_vtk(cls, grid):
        """The hexahedra and voxels of a `vtkUnstructuredGrid`, such as pyvista's.

        Point arrays of 0 and 1 are sets of nodes, cell arrays of 0 and 1 sets of elements. Raises
        InputError if other cells are in it.
        """
        from vtkmodules.util.numpy_support import vtk_to_numpy

        if not hasattr(grid, "GetCellTypesArray"):
            raise TypeError(f"grid must be a vtkUnstructuredGrid, but is a {type(grid).__name__}")
        if grid.GetNumberOfCells() == 0:
            raise _sandglass.InputError("grid has no cells")
        types = vtk_to_numpy(grid.GetCellTypesArray())
        other = sorted(set(types.tolist()) - {_HEXAHEDRON_TYPE, _VOXEL_TYPE})
        if other:
            raise _sandglass.InputError(
                f"grid has cells of VTK's types {other}; they must be hexahedra (12) or voxels (11)"
            )
        cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 8).copy()
        cells[types == _VOXEL_TYPE] = cells[types == _VOXEL_TYPE][:, _VOXEL]

        def sets_of(data):
            sets = {}
            for k in range(data.GetNumberOfArrays()):
                values = vtk_to_numpy(data.GetArray(k)) if data.GetArray(k) else np.zeros(0)
                if values.ndim == 1 and values.any() and np.isin(values, (0, 1)).all():
                    sets[data.GetArrayName(k)] = np.flatnonzero(values)
            return sets

        points = vtk_to_numpy(grid.GetPoints().GetData())
        sets, element_sets = sets_of(grid.GetPointData()), sets_of(grid.GetCellData())
        return cls._of_used(points, cells, sets, element_sets)

    @classmethod
    def _of_used(cls, points, cells, sets, element_sets):
        """A mesh without the nodes that belong to no cell."""
        used = np.zeros(len(points), bool)
        used[cells] = True
        number = np.cumsum(used) - 1
        sets = {name: number[nodes[used[nodes]]] for name, nodes in sets.items()}
        sets = {name: nodes for name, nodes in sets.items() if len(nodes)}
        return cls(np.asarray(points, float)[used], number[cells], sets, element_sets)

    def save(self, file):
        """Writes the mesh as an HDF5 file, which a case names as mesh.file. Needs h5py."""
        import h5py

        file = path_text("file", file)
        partial = file + ".partial"
        with h5py.File(partial, "w") as h5:
            h5["mesh/points"] = self.points
            h5["mesh/cells"] = self.cells.astype("int32")
            for kind in ("sets", "element_sets"):
                for name, members in getattr(self, kind).items():
                    h5[f"mesh/{kind}/{name}"] = members
        os.replace(partial, file)

    def __repr__(self):
        names = ", ".join(map(repr, self.sets))
        counts = f"{len(self.points)} points, {len(self.cells)} cells"
        return f"<sg.Mesh: {counts}, sets: {names or 'none'}>"


def _named(argument, sets):
    """A dict with texts as keys; empty for None."""
    if sets is None:
        return {}
    if not hasattr(sets, "items"):
        raise TypeError(f"{argument} must be a dict, but is a {type(sets).__name__}")
    for name in sets:
        if not isinstance(name, str):
            raise TypeError(f"{argument}: the name {name!r} must be a text")
    return dict(sets)


def _without_masks(sets, rows):
    """The sets, masks as the numbers of the rows for which they are true."""
    shape = np.shape(rows)[:1]

    def members(given):
        is_mask = getattr(given, "dtype", None) == bool and np.shape(given) == shape
        return np.flatnonzero(given) if is_mask else given

    return {name: members(given) for name, given in sets.items()}


def mesh_of_case(table):
    """The mesh of the table [mesh] of a case, as a dict."""
    cls = class_for("mesh", table.get("generator", ""))
    return Mesh._of_keys(table) if cls is None else Mesh.of(cls(**_without(table, "generator")))


def _without(table, key):
    return {name: value for name, value in table.items() if name != key}
