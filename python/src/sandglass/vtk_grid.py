"""Frames as grids of VTK (the package python3-vtk9)."""

import numpy as np

import _sandglass


def vtk_grid(points, cells, frame):
    """A vtkUnstructuredGrid with the arrays of a frame, which it copies."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, vtkCellArray, vtkUnstructuredGrid

    grid = vtkUnstructuredGrid()
    place = vtkPoints()
    place.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(place)
    starts = np.arange(0, cells.size + 1, 8)
    hexahedra = vtkCellArray()
    hexahedra.SetData(
        numpy_to_vtkIdTypeArray(starts.astype(np.int64), deep=True),
        numpy_to_vtkIdTypeArray(cells.ravel().astype(np.int64), deep=True),
    )
    grid.SetCells(VTK_HEXAHEDRON, hexahedra)
    for name, values in frame.items():
        if not isinstance(values, np.ndarray):
            continue
        array = numpy_to_vtk(values.reshape(len(values), -1), deep=True)
        array.SetName(name)
        data = grid.GetPointData() if name in ("displacement", "velocity") else grid.GetCellData()
        data.AddArray(array)
    return grid


def write_vtu(grid, file):
    """Writes a grid as a .vtu file. Raises InputError if it cannot be written."""
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(file)
    writer.SetInputData(grid)
    if not writer.Write():
        raise _sandglass.InputError(f"{file}: cannot be written")
