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
CUBES = (DATA / "cubes.inp").read_text()
NODES, ELEMENTS = CUBES[: CUBES.index("*ELEMENT")], CUBES[CUBES.index("*ELEMENT") :]
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
