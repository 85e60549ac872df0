"""What result files of `sandglass run` hold (HDF5)."""

import h5py


def last_displacement(path):
    """Displacements (n, 3), m, of the last frame."""
    with h5py.File(path, "r") as file:
        return file["frames"][max(file["frames"])]["displacement"][...]


def text_of(attribute):
    """A text attribute; texts of fixed length come out of h5py as bytes. Others as they are."""
    return attribute.decode() if isinstance(attribute, bytes) else attribute
