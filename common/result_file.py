"""Reading the result files of `sandglass run` (HDF5)."""

import h5py


def last_displacement(path):
    """Displacements (n, 3), m, of the last frame."""
    with h5py.File(path, "r") as file:
        return file["frames"][max(file["frames"])]["displacement"][...]


def text_of(attribute):
    """A text attribute as str: h5py returns texts of fixed length as bytes. Others stay as is."""
    return attribute.decode() if isinstance(attribute, bytes) else attribute
