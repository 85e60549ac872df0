"""Storing and reading goldens and truths (HDF5). A file is written whole or not at all."""

import math
import os
import shutil
import tempfile
from pathlib import Path

import h5py
import numpy as np

from errors import InputError

# Every root attribute of a result file, with its type.
ATTRIBUTES = {
    "case": str,
    "case_hash": str,
    "mesh_hash": str,
    "kind": str,
    "element": str,
    "refinements": int,
    "quadrature": str,
    "law": str,
    "mirror_planes": str,
    "boundary_rule": str,
    "largest_imposed": float,  # where nothing is moved: the largest displacement
    "load_steps": int,
    "newton_iterations": int,
    "residual": float,
    "newton_tolerance": float,
    "last_correction": float,
    "dolfinx_version": str,
    "wall_seconds": float,
    "discretisation_error_max": float,
    "discretisation_error_rms": float,
    "discretisation_error_note": str,
    "own_error_max": float,  # distance from the limit of refinement: convergence.py
    "own_error_rms": float,
    "own_error_order": float,
    "own_error_note": str,
}

# What a new result knows of its distance from that limit.
NOT_ESTIMATED = {
    "own_error_max": math.nan,
    "own_error_rms": math.nan,
    "own_error_order": math.nan,
    "own_error_note": "not estimated: reference/convergence.py has not been run",
}


def require_writable(path):
    """Raise InputError unless a result can be written at `path`: asked before the long work."""
    folder = Path(path).resolve().parent
    if not folder.is_dir():
        raise InputError(f"{path}: cannot write: the folder {folder} does not exist")
    if Path(path).is_dir() or not os.access(folder, os.W_OK):
        raise InputError(f"{path}: cannot write: a file in a writable folder is required")


def write_result(path, points, displacement, attributes):
    """Write a result to a temporary file beside `path` and rename it.

    points, displacement: (n, 3) float64, m, in the numbering of the mesh file. attributes: dict
    with exactly the keys of ATTRIBUTES. Raises InputError when the file cannot be written.
    """
    assert set(attributes) == set(ATTRIBUTES), set(attributes) ^ set(ATTRIBUTES)
    require_writable(path)
    path = Path(path).resolve()
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    os.close(handle)
    try:
        with h5py.File(temporary, "w") as file:
            for name, data in (("displacement", displacement), ("points", points)):
                file.create_dataset(
                    name, data=np.asarray(data, dtype=np.float64), shuffle=True, compression="gzip"
                )
            for name, kind in ATTRIBUTES.items():
                file.attrs[name] = kind(attributes[name])
        os.chmod(temporary, 0o644)  # mkstemp makes it readable by its owner only
        os.replace(temporary, path)
    except OSError as error:
        raise InputError(f"{path}: cannot write: {error}") from error
    finally:
        if os.path.exists(temporary):
            os.unlink(temporary)


def write_estimate(path, estimate):
    """Replace the attributes of NOT_ESTIMATED in a stored result; its datasets keep their bytes.

    estimate: dict with those keys. Raises InputError when the file cannot be written.
    """
    assert set(estimate) == set(NOT_ESTIMATED), set(estimate) ^ set(NOT_ESTIMATED)
    require_writable(path)
    path = Path(path).resolve()
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    os.close(handle)
    try:
        shutil.copy(path, temporary)
        with h5py.File(temporary, "r+") as file:
            for name, value in estimate.items():
                file.attrs[name] = ATTRIBUTES[name](value)
        os.replace(temporary, path)
    except OSError as error:
        raise InputError(f"{path}: cannot write: {error}") from error
    finally:
        if os.path.exists(temporary):
            os.unlink(temporary)


def read_result(path):
    """Read a result: (points (n, 3), displacement (n, 3), attributes dict).

    Raises InputError when the file is missing, damaged or lacks an attribute.
    """
    try:
        with h5py.File(path, "r") as file:
            points, displacement = file["points"][...], file["displacement"][...]
            attributes = {name: kind(file.attrs[name]) for name, kind in ATTRIBUTES.items()}
    except OSError as error:
        raise InputError(f"{path}: cannot read the result (HDF5): {error}") from error
    except KeyError as error:
        raise InputError(f"{path}: not a result of this program: {error}") from error
    return points, displacement, attributes
