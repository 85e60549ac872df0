"""Obstacles as surfaces of triangles: on the shape, closed, as fine as the depth of the contact."""

import math
from dataclasses import replace

import numpy as np
import pytest
from test_deck_contact import obstacle
from test_decks import BRICK, problem

from common.errors import InputError
from exchange.decks import rigid_surface
from exchange.decks.contact import SHAPES
from exchange.foreign_mesh import HexMesh


def outside(one, x):
    """The distance (n,) of points from a shape; of an ellipsoid its equation, times an axis."""
    x = x - one.point
    if one.shape == "plane":
        return x @ one.normal / np.linalg.norm(one.normal)
    if one.shape == "ellipsoid":
        return (np.linalg.norm(x / one.half_sizes, axis=1) - 1.0) * one.half_sizes.min()
    axis = one.end - one.point if one.shape != "sphere" else np.zeros(3)
    t = x @ axis / max(axis @ axis, 1e-300)
    t = t.clip(0.0, 1.0) if one.shape == "capsule" else t
    return np.linalg.norm(x - t[:, None] * axis, axis=1) - one.radius


@pytest.mark.parametrize("shape", [s for s in SHAPES if s not in ("box", "surface")])
def test_a_curved_obstacle_is_a_polyhedron_on_it(shape):
    """Points within triangles are inside, by at most the chords of two edges where it touches."""
    one = obstacle(shape)
    corners, triangles = rigid_surface.triangulated(one, BRICK.points, one.overlap)
    assert np.abs(outside(one, corners)).max() < 1e-13
    middles = corners[triangles].mean(axis=1)
    depths, gaps = -outside(one, middles), np.abs(middles - [0.5, 0.5, 0.5]).max(axis=1) - 0.5
    assert depths.min() > -1e-13
    near = gaps < 0.2
    assert near.any() and depths[near].max() <= 2 * rigid_surface.CHORD * one.overlap
    if shape != "plane":
        assert len(triangles) > 100 and depths.max() > 5 * depths[near].max()  # coarser elsewhere


@pytest.mark.parametrize(
    "shape, volume",
    [
        ("sphere", 4 / 3 * math.pi * 8),
        ("capsule", 4 / 3 * math.pi * 8 + 4 * math.pi * math.sqrt(2)),
        ("box", 0.375 * 2),
        ("ellipsoid", 4 / 3 * math.pi * 6),
        ("surface", 0.5),
    ],
)
def test_a_surface_is_closed_and_outward(shape, volume):
    """No edge is split on one side only. A polyhedron with corners on a shape is smaller."""
    one = obstacle(shape)
    corners, triangles = rigid_surface.triangulated(one, BRICK.points, one.overlap)
    edges = {tuple(t[[k, (k + 1) % 3]]) for t in triangles for k in range(3)}
    assert len(edges) == 3 * len(triangles) and {(b, a) for a, b in edges} == edges
    p = corners[triangles] - one.point
    found = np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, 1], p[:, 2])).sum() / 6
    exact = volume if shape in ("box", "surface") else None
    assert found == pytest.approx(exact, rel=1e-12) if exact else 0.9 * volume < found < volume


@pytest.mark.parametrize("inside", [False, True])
@pytest.mark.parametrize("shape", SHAPES)
def test_elements_are_behind_the_surface_that_faces_the_body(shape, inside):
    one = obstacle(shape, inside=inside)
    nodes, cells = rigid_surface.tetrahedra(one, BRICK.points, one.overlap)
    p = nodes[cells]
    normals = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    assert (np.einsum("ij,ij->i", normals, p[:, 3] - p[:, 0]) > 0).all()  # of positive volume
    if shape == "sphere":
        outward = np.einsum("ij,ij->i", normals, p[:, 0] - one.point)
        assert (outward > 0 if inside else outward < 0).all()


def test_the_depth_that_decides_how_fine_a_surface_is():
    """The overlap, unless it is rounding; or what is imposed; or an edge, here of one."""
    case = problem()
    assert rigid_surface.depth_of(obstacle(), case) == 0.1
    assert rigid_surface.depth_of(obstacle(overlap=1e-9), case) == 0.125
    case = replace(case, values=np.zeros((8, 3)))
    assert rigid_surface.depth_of(obstacle(overlap=-0.5), case) == 1.0


def test_a_surface_that_would_be_too_fine_is_refused():
    large = obstacle("ellipsoid", half_sizes=[1e4, 1e4, 2.0], overlap=1e-4)
    wide = HexMesh([1e4, 1e4, 1.0] * BRICK.points, BRICK.cells, {})
    with pytest.raises(InputError, match="obstacle 'ellipsoid': .* over 200000"):
        rigid_surface.triangulated(large, wide.points, large.overlap)
