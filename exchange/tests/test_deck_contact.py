"""Contact in decks: surfaces of obstacles, their exact text, what is refused, and answers of ccx.

The contact of FEBio and OpenRadioss was not run: its texts in data/decks have the structure that
their readers expect (FEBio 4.x: FEBioXML; OpenRadioss 2024: hm_cfg_files).
"""

import math
import re
import shutil
import xml.etree.ElementTree as xml
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command_line import ROOT, ran
from scipy.optimize import brentq
from test_decks import BRICK, DAMPED, NEO_HOOKEAN, TEXTS, problem, texts

from common.errors import InputError
from common.hexahedron import CUBE, boundary_faces
from exchange import decks
from exchange.decks import rigid_surface
from exchange.decks.contact import AT_REST, SHAPES, Obstacle, Pair
from exchange.foreign_mesh import HexMesh

needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="ccx is not installed")
TOP = np.array([[4, 5, 6, 7]])


def obstacle(shape="sphere", **keys):
    """An obstacle above the unit cube that is pressed into it by a tenth."""
    of_shape = {
        "plane": {"point": [0.5, 0.5, 1.0], "normal": [0.0, 0.0, -2.0]},
        "sphere": {"point": [0.5, 0.5, 3.0], "radius": 2.0},
        "capsule": {"point": [0.0, 0.0, 3.0], "end": [1.0, 1.0, 3.0], "radius": 2.0},
        "cylinder": {"point": [0.0, 0.5, 3.0], "end": [1.0, 0.5, 3.0], "radius": 2.0},
        "box": {"point": [0.5, 0.5, 1.5], "half_sizes": [0.25, 0.75, 0.5]},
        "ellipsoid": {"point": [0.5, 0.5, 3.0], "half_sizes": [1.0, 3.0, 2.0]},
        "surface": {"point": [0.5, 0.5, 1.0], "points": TETRAHEDRON, "triangles": ITS_FACES},
    }[shape]
    given = {"name": shape, "faces": TOP, "stiffness": 125.0, "overlap": 0.1}
    given |= {"displacement": [0.0, 0.0, -0.1]} | of_shape | keys
    vectors = ("point", "end", "normal", "half_sizes", "displacement", "points")
    arrays = {key: np.array(value) for key, value in given.items() if key in vectors}
    return Obstacle(**given | {"shape": shape} | arrays)


TETRAHEDRON = [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [-1.0, -1.0, 1.0]]
ITS_FACES = np.array([[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]])
PAIR = Pair("walls", TOP, stiffness=8.0, other_faces=np.array([[0, 3, 2, 1]]), friction=0.25)


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
    # An ellipsoid's chord is measured towards its centre, a bit longer.
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
    """No edge is split on one side only; a polyhedron with corners on a shape is smaller than it."""
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
    """The overlap; or what is imposed; or an edge, here of one: overlaps of rounding count as none."""
    case = problem()
    assert rigid_surface.depth_of(obstacle(), case) == 0.1
    assert rigid_surface.depth_of(obstacle(overlap=1e-9), case) == 0.125
    case = replace(case, values=np.zeros((8, 3)))
    assert rigid_surface.depth_of(obstacle(overlap=-0.5), case) == 1.0


def test_a_surface_that_would_be_too_fine_is_refused():
    large = obstacle("ellipsoid", half_sizes=[1e4, 1e4, 2.0], overlap=1e-4)
    wide = HexMesh(1e4 * BRICK.points, BRICK.cells, {})
    with pytest.raises(InputError, match="obstacle 'ellipsoid': .* more than 200000"):
        rigid_surface.triangulated(large, wide.points, large.overlap)


def touching(motion=None, **contact):
    """The brick of test_decks.py with obstacles and pairs."""
    return replace(problem(motion), **contact)


WALLS = [
    obstacle("plane", friction=0.5),
    obstacle("sphere", method="kinematic"),
    obstacle("cylinder", displacement=[0.25, 0.0, 0.0]),
]
WRITTEN = {
    "touched.inp": ("calculix", ".inp", {"obstacles": WALLS[:1], "pairs": [PAIR]}),
    "touched.feb": ("febio", ".feb", {"obstacles": WALLS[:1], "pairs": [PAIR]}),
    "touched_0000.rad": (
        "openradioss",
        "_0000.rad",
        {"obstacles": WALLS, "pairs": [PAIR, replace(PAIR, other_faces=None)]},
    ),
}


@pytest.mark.parametrize("name", WRITTEN)
def test_contact_of_one_brick(name):
    program, ending, contact = WRITTEN[name]
    found = texts(program, ending, touching(**contact))[f"brick{ending}"]
    assert found == (TEXTS / name).read_text()


def test_hanging_nodes_are_equations():
    """Node 8 is the mean of two others, node 7 of five: four terms on a line, of its own the first."""
    ties = {7: [(0, 0.5), (1, 0.5)], 6: [(n, 0.2) for n in range(5)]}
    text = texts("calculix", ".inp", replace(problem(), ties=ties))["brick.inp"]
    assert "*EQUATION\n3\n8, 2, -1.0, 1, 2, 0.5, 2, 2, 0.5\n*EQUATION\n3\n8, 3, -1.0," in text
    assert "*EQUATION\n6\n7, 1, -1.0, 1, 1, 0.2, 2, 1, 0.2, 3, 1, 0.2\n4, 1, 0.2, 5, 1, 0.2\n" in text


def test_nodes_that_are_wholly_imposed_feel_no_wall():
    text = texts("openradioss", "_0000.rad", touching(obstacles=WALLS[1:2]))["brick_0000.rad"]
    lines = text.splitlines()
    group = lines[lines.index("/RWALL/SPHER/1") + 2].split()[2]
    assert lines[lines.index(f"/GRNOD/NODE/{group}") + 2].split() == ["6", "7", "8"]  # not 5


MOVING = replace(DAMPED, damping=0.0)
REFUSED = [
    ("niftysim", {"obstacles": WALLS[:1]}, "obstacle 'plane': shape = 'plane' is not .* no obst"),
    ("niftysim", {"pairs": [PAIR]}, r"'walls': answer = 'static equilibrium' .* no \[\[contact\]\]"),
    ("openradioss", {"obstacles": [obstacle("box")]}, "'box': shape = 'box' .*: plane, sphere, cyl"),
    (
        "openradioss",
        {"obstacles": [obstacle(inside=True)]},
        "inside = 'true' is not known to OpenRadioss; allowed: false",
    ),
    (
        "openradioss",
        {"obstacles": [obstacle(method="penalty")], "motion": MOVING},
        "'sphere': method = 'penalty' .* allowed: static equilibrium, kinematic",
    ),
    ("openradioss", {"pairs": [PAIR], "motion": MOVING}, "'walls': method = 'kinematic' .* penalty"),
    ("febio", {"obstacles": WALLS[:1], "motion": MOVING}, "'plane': method = 'kinematic' .*FEBio"),
    ("febio", {"pairs": [replace(PAIR, other_faces=None)]}, "no surfaces that touch themselves"),
    ("calculix", {"obstacles": WALLS[:1], "motion": MOVING}, "'kinematic' .* CalculiX"),
    ("febio", {"ties": {7: [(0, 1.0)]}}, "hanging nodes"),
]


@pytest.mark.parametrize("program, contact, message", REFUSED)
def test_contact_that_a_program_does_not_know_is_refused(program, contact, message):
    with pytest.raises(InputError, match=message):
        texts(program, decks.PROGRAMS[program].ENDING, replace(problem(), **contact))


def test_names_that_a_deck_needs_are_refused():
    mesh = HexMesh(BRICK.points, BRICK.cells, {"deck_Body": np.arange(2)})
    with pytest.raises(InputError, match="begin with DECK_"):
        texts("calculix", ".inp", replace(problem(), mesh=mesh))


def test_the_table_of_the_readme():
    """Each program's row is what its module says."""

    def words(these):
        return ", ".join(these) or "-"

    text = (ROOT / "exchange" / "README.md").read_text()
    for name, program in decks.PROGRAMS.items():
        known = program.CONTACT
        kinds = map(words, (known.obstacles, known.pairs, known.itself))
        shapes = "all" if known.shapes == SHAPES else words(known.shapes)
        cells = [f"`{name}`", shapes, "yes" if known.inside else "-", *kinds, known.how]
        assert f"| {' | '.join(cells)} |" in text
