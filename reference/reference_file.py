"""Writes and reads goldens, truths and goldens of motion (HDF5), each completely or not at all."""

import math
import shutil
from pathlib import Path

import h5py
import numpy as np

from common.errors import InputError
from common.files import new_file

FOLDER = Path(__file__).resolve().parent
KINDS = ("golden", "truth")
MOTION = "motion"  # a golden of motion, in its own folder because it has many times

# Every root attribute of such a file, with its type.
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
    "largest_imposed": float,  # or, if nothing is imposed, the largest displacement
    "load_steps": int,  # in motion steps of time
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

# Additional attributes of a motion: its change when the steps were last halved, over
# largest_imposed, the largest of all times.
MOTION_ATTRIBUTES = {"halving_max": float, "halving_rms": float}

# Values of the own_error attributes in a new file.
NOT_ESTIMATED = {
    "own_error_max": math.nan,
    "own_error_rms": math.nan,
    "own_error_order": math.nan,
    "own_error_note": "not estimated: reference/convergence.py has not been run",
}


def path_of(kind, name):
    """The path of a case's stored answer. kind: one of KINDS, or MOTION. name: the case's name."""
    return FOLDER / kind / f"{name}.h5"


def stored(kind):
    """The names of the cases that have a stored answer of this kind, sorted."""
    return sorted(path.stem for path in (FOLDER / kind).glob("*.h5"))


def write_reference(path, points, displacement, attributes, times=None):
    """Writes a golden or truth; with times (t,), s, a golden of motion.

    points, displacement: (n, 3) float64, m, in the numbering of the mesh file; in motion
    displacement is (t, n, 3), stored as displacement/0001, ... attributes: dict with exactly the
    keys of ATTRIBUTES, in motion also MOTION_ATTRIBUTES. Raises InputError if the file cannot be
    written.
    """
    kinds = ATTRIBUTES if times is None else ATTRIBUTES | MOTION_ATTRIBUTES
    assert set(attributes) == set(kinds), set(attributes) ^ set(kinds)
    arrays = {"points": points}
    if times is None:
        arrays["displacement"] = displacement
    else:
        arrays["times"] = times
        arrays |= {_frame(number): u for number, u in enumerate(displacement)}
    with new_file(path) as temporary, h5py.File(temporary, "w") as file:
        for name, data in arrays.items():
            file.create_dataset(
                name, data=np.asarray(data, dtype=np.float64), shuffle=True, compression="gzip"
            )
        for name, kind in kinds.items():
            file.attrs[name] = kind(attributes[name])


def write_estimate(path, estimate):
    """Replaces the attributes of NOT_ESTIMATED in a stored file and leaves its datasets unchanged.

    estimate: dict with those keys. Raises InputError if the file cannot be written.
    """
    assert set(estimate) == set(NOT_ESTIMATED), set(estimate) ^ set(NOT_ESTIMATED)
    with new_file(path) as temporary:
        shutil.copy(path, temporary)
        with h5py.File(temporary, "r+") as file:
            for name, value in estimate.items():
                file.attrs[name] = ATTRIBUTES[name](value)


def read_reference(path):
    """Reads a golden or truth: (points (n, 3), displacement (n, 3), m, attributes dict).

    For a golden of motion displacement is (t, n, 3), and attributes also has its times (t,), s.
    Raises InputError if the file is missing, is damaged or lacks an attribute.
    """
    try:
        with h5py.File(path, "r") as file:
            moving = "times" in file
            kinds = ATTRIBUTES | MOTION_ATTRIBUTES if moving else ATTRIBUTES
            attributes = {name: kind(file.attrs[name]) for name, kind in kinds.items()}
            points = file["points"][...]
            if moving:
                attributes["times"] = file["times"][...]
                frames = [file[_frame(n)][...] for n in range(len(attributes["times"]))]
                displacement = np.array(frames)
            else:
                displacement = file["displacement"][...]
    except OSError as error:
        raise InputError(f"{path}: cannot be read as HDF5: {error}") from error
    except KeyError as error:
        raise InputError(f"{path}: not a golden or truth: {error.args[0]}") from error
    return points, displacement, attributes


def _frame(number):
    """The dataset of a motion's displacements at one of its times, counted from 0."""
    return f"displacement/{number + 1:04}"
