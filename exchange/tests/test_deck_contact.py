"""Contact in decks: surfaces of obstacles, their exact text, what is refused, and answers of ccx.

The contact of FEBio and OpenRadioss was not run: its texts in data/decks have the structure that
their readers expect (FEBio 4.x: FEBioXML; OpenRadioss 2024: hm_cfg_files).
"""

import math
import re
import shutil
from dataclasses import replace

import h5py
import numpy as np
import pytest
from command_line import ROOT, ran, sandglass
from scipy.optimize import brentq
from test_decks import BRICK, DAMPED, NEO_HOOKEAN, TEXTS, problem, texts

from common.errors import InputError
from common.hexahedron import CUBE, boundary_faces
from common.result_file import last_displacement
from exchange import decks, frd_file, matching
from exchange.decks import rigid_surface
from exchange.decks.contact import SHAPES, Obstacle, Pair
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
    """Node 8 is the mean of two others, node 7 of five: four terms on a line, its own the first."""
    ties = {7: [(0, 0.5), (1, 0.5)], 6: [(n, 0.2) for n in range(5)]}
    text = texts("calculix", ".inp", replace(problem(), ties=ties))["brick.inp"]
    assert "*EQUATION\n3\n8, 2, -1.0, 1, 2, 0.5, 2, 2, 0.5\n*EQUATION\n3\n8, 3, -1.0," in text
    assert (
        "*EQUATION\n6\n7, 1, -1.0, 1, 1, 0.2, 2, 1, 0.2, 3, 1, 0.2\n4, 1, 0.2, 5, 1, 0.2\n" in text
    )


def test_nodes_that_are_wholly_imposed_feel_no_wall():
    text = texts("openradioss", "_0000.rad", touching(obstacles=WALLS[1:2]))["brick_0000.rad"]
    lines = text.splitlines()
    group = lines[lines.index("/RWALL/SPHER/1") + 2].split()[2]
    assert lines[lines.index(f"/GRNOD/NODE/{group}") + 2].split() == ["6", "7", "8"]  # not 5


MOVING = replace(DAMPED, damping=0.0)
REFUSED = [
    ("niftysim", {"obstacles": WALLS[:1]}, "obstacle 'plane': shape = 'plane' is not .* no obst"),
    (
        "niftysim",
        {"pairs": [PAIR]},
        r"'walls': answer = 'static equilibrium' .* no \[\[contact\]\]",
    ),
    (
        "openradioss",
        {"obstacles": [obstacle("box")]},
        "'box': shape = 'box' .*: plane, sphere, cyl",
    ),
    (
        "openradioss",
        {"obstacles": [obstacle(inside=True)]},
        "inside = 'true' is not known to OpenRadioss; allowed: false",
    ),
    (
        "openradioss",
        {"obstacles": [obstacle(method="penalty")], "motion": MOVING},
        "'sphere': method = 'penalty' .*; allowed: kinematic",
    ),
    (
        "openradioss",
        {"pairs": [PAIR], "motion": MOVING},
        "'walls': method = 'kinematic' .* penalty",
    ),
    ("febio", {"obstacles": WALLS[:1], "motion": MOVING}, "'plane': method = 'kinematic' .*FEBio"),
    ("febio", {"pairs": [replace(PAIR, other_faces=None)]}, "no surfaces that touch themselves"),
    (
        "calculix",
        {"obstacles": WALLS[:1], "motion": MOVING},
        "'kinematic' .* CalculiX; its decks hold obstacles in static equilibrium only",
    ),
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


# With the solver.

OBSTACLE = """
[sets]
side = { x = [0.1, 0.1] }
foot = { z = [0.0, 0.0] }

[[obstacle]]
name = "tip"
set = "side"
shape = "surface"
file = "tip.obj"
point = [0.11, 0.05, 0.1]
penalty = 2.0
displacement = [-0.02, 0.0, 0.0]
times = [0.0, 1.0]
factors = [0.25, 1.5]
"""


def with_tip(block, **keys):
    """The block with an obstacle that is a tetrahedron in a file. keys: in place of its own."""
    rows = [f"v {x} {y} {z}" for x, y, z in 0.01 * np.array(TETRAHEDRON)[:, [2, 0, 1]]]
    rows += ["f " + " ".join(map(str, face)) for face in ITS_FACES + 1]
    (block.parent / "tip.obj").write_text("\n".join(rows) + "\n")
    text = block.read_text()
    sets, rest = text.index("[sets]"), text.index("[[displacement]]")
    text = text[:sets] + OBSTACLE + "\n" + text[rest:]
    text = text[: text.rindex("[[displacement]]")]  # only the foot is held
    for key, value in keys.items():
        assert f"\n{key} = " in text
        text = re.sub(rf"(?m)^{key} = .*\n", value and f"{key} = {value}\n", text)
    block.write_text(text)
    return block


def test_a_deck_has_the_obstacle_of_the_case(block):
    """It starts a quarter of the way and goes to one and a half of it; its penalty is E over h."""
    deck = block.parent / "deck.inp"
    sandglass("mesh", with_tip(block), "--deck", "calculix", "-o", deck, code=0)
    lines = deck.read_text().splitlines()
    at = lines.index("*NODE, NSET=DECK_OBSTACLE1") + 1
    corners = [[float(word) for word in line.split(", ")[1:]] for line in lines[at : at + 4]]
    shape = 0.01 * np.array(TETRAHEDRON)[:, [2, 0, 1]]
    assert corners == pytest.approx(shape + [0.105, 0.05, 0.1], abs=1e-15)
    assert lines.count("*SURFACE, NAME=RIGID1, TYPE=ELEMENT") == 1
    ways = [line.split(", ") for line in lines if line.startswith("DECK_OBSTACLE1, ")]
    assert [float(way[3]) for way in ways] == pytest.approx([-0.025, 0.0, 0.0], abs=1e-17)
    assert float(lines[lines.index("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR") + 1]) == (
        pytest.approx(2 * 3000 / 0.05, rel=1e-11)
    )
    side = lines.index("*SURFACE, NAME=TOUCHES1, TYPE=ELEMENT") + 1
    assert lines[side : side + 8] == [f"{e}, S4" for e in range(2, 17, 2)]  # those at the largest x


@pytest.mark.parametrize(
    "keys, message",
    [
        ({"set": '"sid"'}, "'sid' is not a node set of this case; did you mean 'side'"),
        (
            {"displacement": "[-0.02, 0.0, 0.0]\nfriction = 0.5"},
            "'tip' follows a curve of its own,",
        ),
        ({"shape": '"cone"'}, "shape"),
    ],
)
def test_contact_that_no_deck_can_hold(block, keys, message):
    words = "--deck", "calculix", "-o", block.parent / "deck.inp"
    sandglass("mesh", with_tip(block, **keys), *words, code=2, message=message)
    assert not (block.parent / "deck.inp").exists()


def test_a_deck_in_a_folder_that_is_missing(block):
    words = "--deck", "calculix", "-o", "none/deck.inp"
    message = "none/deck.inp: cannot be written"
    sandglass("mesh", with_tip(block), *words, code=2, message=message, cwd=block.parent)


# ccx.

N = 2  # elements on each edge of a cube of 1 m
SHEAR, BULK = 1000 / 2.6, 1000 / 1.2  # Pa: E = 1000 Pa, nu = 0.3
STIFFNESS = 120_000.0  # Pa/m


def cubes(count):
    """(mesh, faces at the top of each) of cubes on each other, which share no nodes."""
    grid = np.stack(np.meshgrid(*[np.arange(N + 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    lowest = grid[(grid < N).all(axis=1)]
    cells = (lowest[:, None] + CUBE) @ [(N + 1) ** 2, N + 1, 1]
    faces = boundary_faces(cells)
    ends = [faces[(grid[faces, 2] == height).all(axis=1)] for height in (0, N)]
    points = np.vstack([grid / N + [0, 0, k] for k in range(count)])
    cells = np.vstack([cells + k * len(grid) for k in range(count)])
    return HexMesh(points, cells, {}), *[end + k * len(grid) for k in range(count) for end in ends]


def run_ccx(name, folder, nodes):
    """(force on the body, or on the first surface, of the first contact (3,), N; displacement of
    the nodes (n, 3), m) that ccx finds for a deck of this name."""
    done = ran("ccx", name, cwd=folder)
    assert done.returncode == 0, done.stdout[-2000:]
    lines = (folder / f"{name}.dat").read_text().splitlines()
    at = next(i for i, line in enumerate(lines) if "total surface force" in line)
    points, displacement = frd_file.read(folder / f"{name}.frd")
    rows = matching.by_coordinates(nodes, points, 1e-5, f"{name}.frd")
    return np.array([float(word) for word in lines[at + 2].split()[:3]]), displacement[rows]


def answer_of_ccx(folder, mesh, held, moved=0.0, **contact):
    """run_ccx of cubes.

    held: components imposed at all nodes, besides all of them at the base and the top of two cubes,
    which moves by `moved` along z.
    """
    points = mesh.points
    ends = (points[:, 2] == 0) | (points[:, 2] == 2)
    prescribed, values = np.repeat(ends[:, None], 3, axis=1), np.zeros_like(points)
    prescribed[:, held] = True
    values[points[:, 2] == 2, 2] = moved
    moduli = {"shear_modulus": SHEAR, "bulk_modulus": BULK, "elements": np.arange(len(mesh.cells))}
    case = replace(
        problem(),
        mesh=mesh,
        materials=[replace(NEO_HOOKEAN, **moduli)],
        prescribed=prescribed,
        values=values,
        forces=np.zeros_like(points),
        **contact,
    )
    for path, text in decks.files("calculix", case, folder / "cube.inp").items():
        path.write_text(text)
    return run_ccx("cube", folder, points)


def pressure(stretch):
    """Of a confined cube of this height, Pa; negative: pressed."""
    return BULK * (stretch - 1) + 2 / 3 * SHEAR * stretch ** (-5 / 3) * (stretch**2 - 1)


@needs_ccx
def test_ccx_presses_a_confined_cube_as_the_energy_says(tmp_path):
    """Uniform strain; the plane sinks in by pressure over stiffness, a hundredth of its way. ccx
    prints seven digits."""
    mesh, _, top = cubes(1)
    one = obstacle("plane", faces=top, stiffness=STIFFNESS)
    found, u = answer_of_ccx(tmp_path, mesh, held=[0, 1], obstacles=[one])
    stretch = brentq(lambda s: pressure(s) + STIFFNESS * (s - 0.9), 0.8, 1.0, xtol=1e-14)
    assert stretch - 0.9 > 1e-3  # a rigid contact would err by 1 % in the force
    assert found == pytest.approx([0.0, 0.0, pressure(stretch)], abs=5e-5)
    assert u[:, 2] == pytest.approx((stretch - 1) * mesh.points[:, 2], abs=5e-8)  # .frd: six


@needs_ccx
def test_ccx_presses_two_confined_cubes_as_the_energy_says(tmp_path):
    """Each has half of what is left after they sink into each other; nodes that touch at the start
    are at one place."""
    mesh, _, top, base, _ = cubes(2)
    pair = Pair("both", top, stiffness=STIFFNESS, other_faces=base)
    found, u = answer_of_ccx(tmp_path, mesh, held=[0, 1], moved=-0.2, pairs=[pair])
    stretch = brentq(lambda s: pressure(s) + STIFFNESS * (2 * s - 1.8), 0.8, 1.0, xtol=1e-14)
    assert found == pytest.approx([0.0, 0.0, pressure(stretch)], abs=5e-5)
    assert u[np.unique(top), 2] == pytest.approx(stretch - 1, abs=5e-8)
    assert u[np.unique(base), 2] == pytest.approx(-0.2 + 1 - stretch, abs=5e-7)


@needs_ccx
def test_ccx_rubs_a_cube_as_coulomb_says(tmp_path):
    """All of the top slips along x; its motion along y is held."""
    mesh, _, top = cubes(1)
    keys = {"friction": 0.05, "displacement": [0.3, 0.0, -0.1]}
    one = obstacle("plane", faces=top, stiffness=STIFFNESS, **keys)
    found, _ = answer_of_ccx(tmp_path, mesh, held=[1], obstacles=[one])
    assert found[2] < -100 and found[0] == pytest.approx(0.05 * -found[2], rel=1e-6)


def both_answers(case, folder):
    """Of tl-full and of the same element in ccx: two pairs of a force (3,), N, and displacements
    (n, 3), m."""
    sandglass("mesh", case, "--deck", "calculix", "-o", folder / "deck.inp", code=0)
    sandglass("run", case, "-m", "tl-full", "-o", folder / "own.h5", code=0)
    with h5py.File(folder / "own.h5") as file:
        (name,) = (name for name in file["history/reaction"] if name in ("ball", "touch"))
        own = file["history/reaction"][name][-1], last_displacement(folder / "own.h5")
        return own, run_ccx("deck", folder, file["mesh/points"][...])


@needs_ccx
def test_ccx_finds_the_force_of_hertz_case(tmp_path):
    """In ccx the faces of the body touch, not its nodes: in the middle of a face the ball is deeper
    by the sagitta of its diagonal. Chords of the ball, and its sinking in by pressure over
    stiffness, make it less deep. The force grows with the depth to the power of 1.5 (cases/hertz).
    """
    (own, _), (found, _) = both_answers("hertz-8", tmp_path)
    depth, edge, radius = 1e-3, 0.025, 10.0
    deeper = 2 * edge**2 / (8 * radius)
    sunk = 9.549e4 / (30 * 14_062_500 / edge)  # pressure over stiffness
    less = rigid_surface.CHORD * depth + sunk
    ratio = found[2] / own[2]
    assert (1 - less / depth) ** 1.5 < ratio < (1 + deeper / depth) ** 1.5  # 0.976 to 1.024
    assert ratio != pytest.approx(1.0, abs=1e-4)  # these are two programs


@needs_ccx
def test_ccx_finds_the_answer_of_two_spheres(tmp_path):
    """In both programs points of faces touch. In ccx they sink in by pressure over stiffness, which
    we augment away: less approach is left, and the force grows with it to the power of 1.5. Our
    points err by as much as their force is not symmetric."""
    (own, u), (found, displacement) = both_answers("two-spheres", tmp_path)
    approach, edge = 0.01, 0.0107853  # the shortest
    sunk = 4.775e5 / (30 * 14_062_500 / edge)
    assert np.linalg.norm(displacement - u, axis=1).max() < sunk  # 0.25 % of what is imposed
    uneven = np.linalg.norm(own[:2]) / abs(own[2])
    assert uneven < 1.5e-3
    assert (1 - sunk / approach) ** 1.5 - uneven < found[2] / own[2] < 1
