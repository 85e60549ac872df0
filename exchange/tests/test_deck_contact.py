"""Contact in decks: its exact text, what is refused, and what the case gives.

The contact of FEBio and OpenRadioss was not run: its texts in data/decks have the structure that
their readers expect (FEBio 4.x: FEBioXML; OpenRadioss 2024: hm_cfg_files).
"""

import re
import xml.etree.ElementTree as xml
from dataclasses import replace

import numpy as np
import pytest
from command_line import ROOT, sandglass
from test_decks import BRICK, DAMPED, TEXTS, problem, texts

from common.errors import InputError
from exchange import decks
from exchange.decks.contact import SHAPES, Obstacle, Pair
from exchange.foreign_mesh import HexMesh

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


def test_names_in_the_contact_of_febio_are_defined():
    """What a section of FEBio refers to stands in one before it."""
    case = touching(obstacles=WALLS, pairs=[PAIR])
    root = xml.fromstring(texts("febio", ".feb", case)["brick.feb"])

    def names(path, key="name"):
        return [one.get(key) for one in root.findall(path)]

    surfaces, materials = names("Mesh/Surface"), names("Material/material")
    pairs = [pair[k].text for k in (0, 1) for pair in root.findall("Mesh/SurfacePair")]
    assert sorted(pairs) == sorted(surfaces) and len(set(surfaces)) == 8
    assert names("Contact/contact", "surface_pair") == names("Mesh/SurfacePair")
    assert set(names("MeshDomains/SolidDomain")) == set(names("Mesh/Elements"))
    assert names("MeshDomains/SolidDomain", "mat") == materials
    assert {one.text for one in root.findall("Rigid/rigid_bc/rb")} == set(materials[1:])
    nodes = [int(node.get("id")) for node in root.findall("Mesh/Nodes/node")]
    elements = [int(one.get("id")) for one in root.findall("Mesh/Elements/elem")]
    for ids in (nodes, elements):
        assert ids == list(range(1, len(ids) + 1))
    used = [one.text for path in ("Elements", "Surface") for one in root.findall(f"Mesh/{path}/*")]
    assert {int(n) for row in used for n in row.split(",")} == set(nodes)
    order = [section.tag for section in root]
    assert order.index("Mesh") < order.index("Rigid") < order.index("Contact")


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
