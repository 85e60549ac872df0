"""Uniform subdivision preserves the geometry, the nodes and their prescribed values."""

import numpy as np

from blocks import affine_patch
from hexahedra import refine

GRADIENT = np.diag([0.1, 0.2, 0.3])


def _volume(mesh):
    """Volume of every cell by 2x2x2 Gauss points, exact for trilinear hexahedra."""
    signs = np.array([(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1)])
    signs = np.vstack([signs, signs + [0, 0, 2]])
    total = 0.0
    for point in signs / np.sqrt(3):
        factors = 1 + signs * point
        derivative = signs / 8 * np.stack([np.delete(factors, i, 1).prod(1) for i in range(3)], 1)
        jacobian = np.einsum("eai,aj->eij", mesh.points[mesh.cells], derivative)
        total = total + np.linalg.det(jacobian)
    return total


def test_children_fill_their_parent():
    coarse = affine_patch(GRADIENT)
    fine = refine(coarse)
    assert len(fine.cells) == 8 * len(coarse.cells)
    assert len(fine.points) == 7**3  # a 3 x 3 x 3 block becomes 6 x 6 x 6
    volume = _volume(fine)
    assert (volume > 0).all()
    # Eight trilinear children of a trilinear parent: equal up to round-off of numbers < 1.
    assert np.abs(volume.reshape(-1, 8).sum(axis=1) - _volume(coarse)).max() < 1e-15


def test_old_nodes_come_first_and_conditions_are_inherited():
    coarse = affine_patch(GRADIENT)
    fine = refine(coarse)
    n = len(coarse.points)
    assert (fine.points[:n] == coarse.points).all()  # exact: copied
    # The boundary of the cube consists of whole faces of the set; so does the fine boundary ...
    on_boundary = ((fine.points == 0) | (fine.points == 1)).any(axis=1)
    prescribed, imposed = fine.imposed()
    assert (prescribed == on_boundary[:, None]).all()
    # ... with the values of the affine field: means of up to eight numbers < 1.
    assert np.abs(imposed - fine.points @ GRADIENT)[on_boundary].max() < 1e-15
