"""Reads labelled images as meshes: one hexahedron for each voxel that has a label."""

import numpy as np

from common.errors import InputError
from common.hexahedron import CUBE
from exchange.foreign_mesh import HEXAHEDRON, Block, ForeignMesh

MOST_LABELS = 1000
MILLIMETRES = 1e-3  # unit of NIfTI's coordinates in m, unless a file says otherwise


def read_npy(path, spacing):
    """The ForeignMesh of a NumPy array (nx, ny, nz) of labels, whole numbers; 0 is no material.

    spacing: size of a voxel (3,) in m; the corner of the first voxel is the origin. Each label L
    is the element set "label-L". Raises InputError.
    """
    if spacing is None:
        raise InputError(f"{path}: mesh.spacing = [x, y, z], the size of a voxel in m, is missing")
    try:
        labels = np.load(path, allow_pickle=False)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as a NumPy array: {error}") from error
    return _voxels(path, labels, np.diag(spacing), np.zeros(3))


def read_nifti(path, spacing):
    """The same for a NIfTI image, whose header has the size and position of its voxels.

    spacing: must be None.
    """
    if spacing is not None:
        raise InputError(f"{path}: mesh.spacing was given, but the file's header has it")
    import nibabel  # imported only if needed, as few install it

    nibabel.imageglobals.logger.level = 100  # faults are refused, not printed
    try:
        with nibabel.imageglobals.ErrorLevel(30):  # and not repaired
            image = nibabel.load(path)
        labels, affine = np.asanyarray(image.dataobj), image.affine
        name = image.header.get_xyzt_units()[0]
        unit = {"meter": 1.0, "micron": 1e-6}.get(name, MILLIMETRES)
    except Exception as error:  # a library may fail in any way on a damaged file
        reason = f"code {error} in its header is unknown" if isinstance(error, KeyError) else error
        raise InputError(f"{path}: cannot be read as NIfTI: {reason}") from error
    # The affine map places the middle of voxel (i, j, k) at (i, j, k).
    map_, origin = unit * affine[:3, :3], unit * affine[:3, 3]
    mesh = _voxels(path, labels, map_, origin - map_ @ (0.5, 0.5, 0.5))
    mesh.notes += _doubts(image.header, affine, name)
    size = image.dataobj.offset + labels.size * image.get_data_dtype().itemsize
    if path.suffix.lower() == ".nii" and (left := path.stat().st_size - size):
        shape = " x ".join(map(str, labels.shape))
        mesh.notes.append(f"{left} bytes follow its {shape} voxels: does the header fit the file?")
    return mesh


def _doubts(header, affine, unit):
    """Notes on a NIfTI header that leaves open where and how large its voxels are."""
    if unit == "unknown":
        yield "the header names no unit of length; mm is assumed"
        unit = "mm"
    others, sizes = [], np.array(header.get_zooms()[:3], float)
    if header["qform_code"] > 0:
        try:
            others.append(header.get_qform())
        except Exception as error:  # as above
            yield f"its qform is damaged: {error}"
    if not header["qform_code"] and not header["sform_code"]:
        yield (
            "has neither sform nor qform, hence no place and no handedness: its middle is put at "
            "the origin, and x decreases with the first index"
        )
    elif header["sform_code"] > 0:
        found = np.linalg.norm(affine[:3, :3], axis=0)
        others.append(affine @ np.diag([*sizes / np.where(found > 0, found, 1), 1]))
    ends = np.array([[0, 0, 0, 1], [*header.get_data_shape()[:3], 1]])
    shift = max((abs((other - affine) @ ends.T).max() for other in others), default=0.0)
    if shift > 0.1 * sizes.min():
        yield f"sform, which is used, and qform or pixdim differ by {shift:.3g} {unit}"


def _voxels(path, labels, map_, origin):
    """The ForeignMesh of labels (nx, ny, nz); map_ (3, 3) and origin (3,) place corners, in m."""
    if labels.ndim == 4 and labels.shape[3] == 1:
        labels = labels[..., 0]
    if labels.ndim != 3:
        raise InputError(f"{path}: has shape {labels.shape}; (nx, ny, nz) is required")
    if labels.dtype.kind not in "biuf":
        raise InputError(f"{path}: holds {labels.dtype}; labels must be whole numbers")
    if labels.dtype.kind == "f":
        whole = np.round(labels)
        # A scale in the header leaves the rounding of floats.
        near = abs(labels - whole) <= np.clip(1e-6 * abs(whole), 1e-6, 0.01)
        if not (near & (abs(whole) < 2**53)).all():
            raise InputError(f"{path}: labels must be whole numbers")
        labels = whole
    places = np.argwhere(labels)
    if not len(places):
        raise InputError(f"{path}: has no label other than 0; no voxel would be an element")
    values = labels[tuple(places.T)].astype(np.int64)
    names = np.unique(values)
    if len(names) > MOST_LABELS:
        raise InputError(
            f"{path}: has {len(names)} labels; allowed are {MOST_LABELS}: is it a grey image?"
        )
    mirrors = np.linalg.det(map_) < 0  # then bottom and top change places
    corners = np.roll(CUBE, 4, axis=0) if mirrors else CUBE
    shape = np.array(labels.shape) + 1
    number = np.ravel_multi_index((places[:, None] + corners).reshape(-1, 3).T, shape)
    nodes, cells = np.unique(number, return_inverse=True)
    points = np.stack(np.unravel_index(nodes, shape), axis=1) @ map_.T + origin
    ids = np.arange(len(places))
    block = Block(HEXAHEDRON, 3, ids, cells.reshape(-1, 8))
    sets = {("", f"label-{name}"): np.flatnonzero(values == name) for name in names}
    return ForeignMesh(np.arange(len(points)), points, [block], element_sets=sets)
