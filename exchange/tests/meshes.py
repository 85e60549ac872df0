"""Shared by the tests of exchange/: running the program, small meshes, reading its output."""

import contextlib
import io
from pathlib import Path

import h5py
import meshio
import numpy as np

from exchange import convert

DATA = Path(__file__).resolve().parent / "data"

# A unit cube and one on top of it, as Abaqus writes them.
NODES = """\
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
9, 0., 0., 2.
10, 1., 0., 2.
11, 1., 1., 2.
12, 0., 1., 2.
"""
ELEMENTS = """\
*ELEMENT, TYPE=C3D8R, ELSET=tissue
1, 1, 2, 3, 4, 5, 6, 7, 8
2, 5, 6, 7, 8, 9, 10, 11, 12
"""
CUBES = NODES + ELEMENTS
POINTS = np.array([line.split(",")[1:] for line in NODES.splitlines()[1:]], dtype=float)
CELLS = np.array([range(8), range(4, 12)])


class Refused(Exception):
    """The message of the program when it ended with code 2."""


def run(capsys, *arguments):
    """Runs convert.py and returns its standard error. Raises Refused if it ends with 2.

    For any input it must end with 0 or 2, and must print exactly one line in the second case.
    """
    code = convert.main([str(argument) for argument in arguments])
    said = capsys.readouterr()
    assert code in (0, 2), said.out
    if code:
        assert len(said.out.splitlines()) == 1 and said.out.strip(), said.out
        raise Refused(said.out.strip())
    assert not said.out
    return said.err


def read(capsys, path):
    """(points, cells, sets, warnings) of a mesh file, by convert.py and back."""
    output = path.with_name("converted.h5")
    warnings = run(capsys, "mesh", path, output)
    with h5py.File(output) as file:
        sets = {name: nodes[...].tolist() for name, nodes in file.get("mesh/sets", {}).items()}
        return file["mesh/points"][...], file["mesh/cells"][...], sets, warnings


def write(
    path, points=POINTS, cells=CELLS, kind="hexahedron", point_data=None, cell_data=None, **options
):
    """Writes a .vtu file with one kind of cells."""
    grid = meshio.Mesh(points, [(kind, np.array(cells))], point_data or {}, cell_data or {})
    with contextlib.redirect_stderr(io.StringIO()):  # it warns of files of text
        meshio.vtu.write(path, grid, **options)
    return path
