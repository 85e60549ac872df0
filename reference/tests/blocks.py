"""Small distorted meshes for the tests, with node numbers shuffled so that no order is natural."""

from pathlib import Path

import h5py
import numpy as np
import pytest

from case_file import Material
from common.hexahedron import CUBE
from hexahedra import Condition, HexMesh, refine
from problem import MixedProblem
from taylor_hood import TaylorHoodProblem
from tetrahedra import cut

MATERIAL = {"young_modulus": 3000.0, "poisson_ratio": 0.49}
MATERIALS = [Material("neo-hookean", MATERIAL)]
CASE = Path(__file__).with_name("block.toml").read_text()


def distorted_block(n=3, distortion=0.15, seed=1):
    """Points (k, 3) and VTK cells (n^3, 8) of the unit cube, and its (k,) boundary nodes as bool.

    Interior nodes are moved by up to `distortion` of an element; nodes and cells are shuffled.
    """
    random = np.random.default_rng(seed)
    i, j, k = np.meshgrid(*[np.arange(n + 1)] * 3, indexing="ij")
    lattice = np.stack([i.ravel(), j.ravel(), k.ravel()], axis=1)
    boundary = ((lattice == 0) | (lattice == n)).any(axis=1)
    points = lattice / n
    points[~boundary] += distortion / n * random.uniform(-1, 1, (np.sum(~boundary), 3))
    shuffled = random.permutation(len(points))  # new number of each lattice node
    first = lattice[(lattice < n).all(axis=1)]
    corners = first[:, None, :] + CUBE
    cells = shuffled[(corners @ [(n + 1) ** 2, n + 1, 1])]
    order = np.argsort(shuffled)
    return points[order], random.permutation(cells), boundary[order]


def affine(points, gradient):
    """Displacement (k, 3) with a constant gradient (3, 3)."""
    return points @ np.asarray(gradient).T


def affine_patch(gradient, bulge=0.0, **block):
    """HexMesh of a distorted block whose boundary follows an affine displacement.

    bulge: adds bulge x^2 to the boundary's z displacement, so that the answer is not affine.
    """
    points, cells, boundary = distorted_block(**block)
    values = affine(points, gradient)
    values[:, 2] += bulge * points[:, 0] ** 2
    return HexMesh(points, cells, (Condition(boundary, (0, 1, 2), values),))


def pressed_block(value=(0.0, 0.0, -0.2), distortion=0.0):
    """A 4 x 4 x 4 block, held at the bottom; part of the top follows `value`."""
    points, cells, _ = distorted_block(n=4, distortion=distortion)
    values = np.tile(value, (len(points), 1))
    pressed = (points[:, 2] == 1) & (np.abs(points[:, 0] - 0.5) < 0.3)
    bottom = Condition(points[:, 2] == 0, (0, 1, 2), np.zeros_like(points))
    return HexMesh(points, cells, (bottom, Condition(pressed, (0, 1, 2), values)))


def write_mesh(path, points, cells, sets, case="block"):
    """A mesh file as `sandglass mesh` writes it, with invented hashes."""
    with h5py.File(path, "w") as file:
        file["mesh/points"] = points
        file["mesh/cells"] = cells.astype(np.int64)
        for name, nodes in sets.items():
            file[f"mesh/sets/{name}"] = np.asarray(nodes, dtype=np.int64)
        file.attrs["case"] = case
        file.attrs["case_hash"] = "0123456789abcdef"
        file.attrs["mesh_hash"] = "fedcba9876543210"


def with_hanging_nodes(mesh, split):
    """A HexMesh of which the cells with the numbers `split` are split into eight, by themselves."""
    fine, split = refine(mesh), np.asarray(split, dtype=int)
    whole = np.setdiff1d(np.arange(len(mesh.cells)), split)
    children = 8 * np.repeat(split, 8) + np.tile(np.arange(8), len(split))
    cells = np.concatenate([mesh.cells[whole], fine.cells[children]])
    kept, number = np.unique(cells, return_inverse=True)
    conditions = tuple(
        Condition(c.nodes[kept], c.components, c.values[kept]) for c in fine.conditions
    )
    return HexMesh(fine.points[kept], number.reshape(cells.shape), conditions)


def taylor_hood(mesh, materials):
    """The problem of a HexMesh cut into tetrahedra; the nodes of the HexMesh come first."""
    return TaylorHoodProblem(cut(mesh), materials)


ELEMENTS = pytest.mark.parametrize(
    "make", [MixedProblem, taylor_hood], ids=["hexahedra", "tetrahedra"]
)
