"""What commands report of a body before they compute: free motions, parts, seams, sets, units."""

import re

import numpy
import pytest
from command_line import BARE, BLOCK, dynamic, sandglass

CORNERS = [(x, y, z) for z in (0.0, 0.1) for y in (0.0, 0.1) for x in (0.0, 0.1)]
ORDER = (1, 2, 4, 3, 5, 6, 8, 7)
# The block between plates without friction.
BETWEEN_PLATES = BARE.replace("0.0]\n\n", '0.0]\ncomponents = "z"\n\n').replace(
    "[0.02, 0.0, 0.01]", '[0.0, 0.0, 0.01]\ncomponents = "z"'
)


def two_cubes(gap, unit=1.0):
    """An Abaqus input: a cube of .1 m on another, each with its own nodes, `gap` m apart; in
    multiples of `unit`."""
    points = CORNERS + [(x, y, z + 0.1 + gap) for x, y, z in CORNERS]
    points = [(x * unit, y * unit, z * unit) for x, y, z in points]
    rows = [f"{n}, {x!r}, {y!r}, {z!r}" for n, (x, y, z) in enumerate(points, 1)]
    cells = [
        ", ".join(str(n) for n in (e + 1, *(8 * e + corner for corner in ORDER))) for e in (0, 1)
    ]
    return "\n".join(["*NODE", *rows, "*ELEMENT, TYPE=C3D8", *cells, ""])


def on_mesh(name, more=""):
    """The block's case with the mesh of a file, and `tables` instead of its head's."""
    start, end = BARE.index("[mesh]"), BARE.index("[material]")
    text = BARE[:start] + f'[mesh]\nfile = "{name}"\n\n' + BARE[end:]
    return text[: text.rindex("[[displacement]]")] + more if more else text


def refusal(case, command="run"):
    outcome = sandglass(command, case)
    assert outcome.returncode == 2 and outcome.stdout == "", outcome.stderr
    return outcome.stderr


def test_loads_that_end_before_their_tables_are_noted(tmp_path):
    case = tmp_path / "case.toml"
    held = BARE[: BARE.rindex("[[displacement]]")]
    force = '[[force]]\nset = "head"\ntotal = [0.0, 0.0, 0.01]\nfactors = [0.0, 1.0]\n'
    for last, noted in [("1.0", False), ("10.0", True)]:
        case.write_text(f"{held}{force}times = [0.0, {last}]\n")
        said = sandglass("run", case, code=0).stdout
        assert ("note: times of a load reach 10, but static answers end at 1" in said) == noted
    for ramp, noted in [(0.02, False), (0.1, True)]:
        case.write_text(dynamic(BARE, duration=0.02, ramp_time=ramp))
        said = sandglass("run", case, code=0).stdout
        words = "note: ramp_time = 0.1 s is longer than duration = 0.02 s: loads reach 0.058 of"
        assert (words in said) == noted


@pytest.mark.parametrize("command", ["run", "verify", "choose"])
def test_a_cube_between_frictionless_plates_is_free_to_slide(tmp_path, command):
    case = tmp_path / "only-z.toml"
    case.write_text(BETWEEN_PLATES)
    assert case.read_text().count("components") == 2
    said = refusal(case, command)
    assert str(case) in said
    assert "nothing holds the body against translation along x and y, rotation about z" in said
    assert "(to hold it, impose for instance " in said


def test_the_nodes_that_are_named_hold_the_body(tmp_path):
    """Each as a set of its own, in the components named: with them the run finishes."""
    case = tmp_path / "only-z.toml"
    text = BETWEEN_PLATES
    case.write_text(text)
    named = re.findall(r"([xyz]+) of node \d+ at \((\S+), (\S+), (\S+)\) m", refusal(case))
    assert sum(len(components) for components, *_ in named) == 3  # as many as are free
    sets, tables = "", ""
    for n, (components, x, y, z) in enumerate(named):
        sets += f"place{n} = {{ x = [{x}, {x}], y = [{y}, {y}], z = [{z}, {z}] }}\n"
        tables += (
            f'[[displacement]]\nset = "place{n}"\nvalue = [0.0, 0.0, 0.0]\n'
            f'components = "{components}"\n\n'
        )
    case.write_text(text.replace("head = ", sets + "head = ") + tables)
    outcome = sandglass("run", case)
    assert outcome.returncode == 0, outcome.stderr


def test_a_force_that_nothing_resists_is_refused_and_a_support_resists_it(tmp_path):
    case = tmp_path / "pushed.toml"
    force = '[[force]]\nset = "head"\ntotal = [0.1, 0.0, 0.0]\n'
    case.write_text(BARE[: BARE.index("[[displacement]]")] + force)
    assert "nothing holds the body against every translation and rotation" in refusal(case)
    case.write_text(case.read_text() + '\n[[support]]\nset = "foot"\nstiffness = 1e6\n')
    assert sandglass("run", case).returncode == 0


def test_a_loose_voxel_is_named(tmp_path):
    image = numpy.zeros((6, 4, 4), dtype=numpy.uint8)
    image[:4] = 1
    image[5, 3, 3] = 1
    numpy.save(tmp_path / "island.npy", image)
    case = tmp_path / "island.toml"
    weight = "[[gravity]]\nvalue = [0.0, 0.0, -9.81]\n"
    case.write_text(
        on_mesh("island.npy", weight)
        .replace('"island.npy"', '"island.npy"\nspacing = [0.001, 0.001, 0.001]')
        .replace("head = { z = [0.2, 0.2] }\n", "")
    )
    said = refusal(case)
    assert "65 elements in 2 parts" in said
    assert (
        "nothing holds 1 of 65 elements around (0.0055, 0.0035, 0.0035) m "
        "against every translation and rotation"
    ) in said


def test_a_free_body_in_motion_is_only_noted(tmp_path):
    case = tmp_path / "free.toml"
    case.write_text(dynamic(BARE[: BARE.index("[[displacement]]")], duration=0.01))
    outcome = sandglass("run", case)
    assert outcome.returncode == 0, outcome.stderr
    assert "note: nothing holds the body against every translation and rotation" in outcome.stdout


@pytest.mark.parametrize("gap", [0.0, 1e-9])
def test_a_seam_is_warned_of_and_each_part_is_held_or_named(tmp_path, gap):
    (tmp_path / "seam.inp").write_text(two_cubes(gap))
    case = tmp_path / "seam.toml"
    case.write_text(on_mesh("seam.inp").replace("[0.02, 0.0, 0.01]", "[0.0, 0.0, 0.02]"))
    outcome = sandglass("run", case)
    assert outcome.returncode == 0, outcome.stderr  # the upper cube moves as a whole
    assert "4 pairs of boundary nodes lie at one place" in outcome.stderr
    assert "largest displacement 20 mm" in outcome.stdout
    case.write_text(on_mesh("seam.inp", '[[force]]\nset = "head"\ntotal = [0.0, 0.0, 1.0]\n'))
    said = refusal(case)
    assert "2 elements in 2 parts; 4 pairs of boundary nodes lie at one place" in said
    assert "nothing holds 1 of 2 elements around (0.05, 0.05, 0.15) m against every" in said


@pytest.mark.parametrize(
    "words, of",
    [
        (["run"], ""),
        (["mesh", "-o", "out.h5"], ""),
        (["choose", "--tolerance", "90%", "-m", "tl-full"], ""),
        (["verify", "--no-costs"], "block: "),
        (["bench", "-m", "tl-full", "--repetitions", "1", "--threads", "1"], "block: "),
        (["bench", "--rest", "-m", "tl-full"], "block: "),
        (
            [
                "stability",
                "--map",
                "kappa",
                "--values",
                "kappa=0.1",
                "--methods",
                "tl-perturbation",
            ],
            "block: ",
        ),
        (["score", "answer.h5"], "block: "),
    ],
)
def test_every_command_that_computes_with_a_body_says_what_it_understood(tmp_path, words, of):
    """A seam, two parts, and 20 m of what is probably 20 mm."""
    (tmp_path / "seam.inp").write_text(two_cubes(0.0, 100.0))
    text = on_mesh("seam.inp").replace("[0.02, 0.0, 0.01]", "[0.0, 0.0, 0.02]")
    (tmp_path / "seam.toml").write_text(text.replace("[0.2, 0.2]", "[20.0, 20.0]"))
    case = ["--case", "seam.toml"] if "score" in words else ["seam.toml"]
    if "score" in words:
        sandglass("run", "seam.toml", "-o", "answer.h5", cwd=tmp_path, code=0)
    outcome = sandglass(words[0], *case, *words[1:], cwd=tmp_path, code=0)
    assert f"warning: {of}4 pairs of boundary nodes lie at one place" in outcome.stderr
    assert f"warning: {of}the mesh is 20 m long, and files are read in m" in outcome.stderr
    assert f"{of}parts: 1 element, " in outcome.stdout


def test_a_rule_that_replaces_a_set_of_the_file_is_noted(tmp_path):
    for name in ("head", "HEAD"):  # the second is another name
        (tmp_path / "a.inp").write_text(two_cubes(0.0) + f"*NSET, NSET={name}\n1, 2\n")
        (tmp_path / "a.toml").write_text(on_mesh("a.inp").replace("0.02, 0.0, 0.01", "0, 0, 0.02"))
        outcome = sandglass("run", tmp_path / "a.toml", code=0)
        note = "note: sets.head (4 nodes) replaces the set of that name in the mesh (2 nodes)"
        assert (note in outcome.stdout) == (name == "head")


def test_a_thin_element_is_no_seam(tmp_path):
    """Two elements that share nodes; the upper one is 1e-7 times as high as it is wide."""
    text = two_cubes(-0.1 + 1e-8).replace("\n2, 9, 10, 12, 11,", "\n2, 5, 6, 8, 7,")
    (tmp_path / "thin.inp").write_text(text)
    case = tmp_path / "thin.toml"
    case.write_text(on_mesh("thin.inp").replace("[0.2, 0.2]", "[0.1, 0.1001]"))
    outcome = sandglass("mesh", case, "-o", tmp_path / "out.h5", code=0)
    assert "dropped 4 nodes of no hexahedron" in outcome.stderr
    assert "lie at one place" not in outcome.stderr


def box_mesh(rounded):
    """A box of 2 x 2 x 3 elements, .1 x .1 x .3 m, with `rounded` added at every other top node."""
    points = [(0.05 * i, 0.05 * j, 0.1 * k) for k in range(4) for j in range(3) for i in range(3)]
    points[27:] = [(x, y, rounded(z) if n % 2 else z) for n, (x, y, z) in enumerate(points[27:])]
    rows = [f"{n}, {x!r}, {y!r}, {z!r}" for n, (x, y, z) in enumerate(points, 1)]
    cells = []
    for k in range(3):
        for j in range(2):
            for i in range(2):
                first = 9 * k + 3 * j + i + 1
                below = [first, first + 1, first + 4, first + 3]
                nodes = [len(cells) + 1, *below, *(n + 9 for n in below)]
                cells.append(", ".join(map(str, nodes)))
    return "\n".join(["*NODE", *rows, "*ELEMENT, TYPE=C3D8", *cells, ""])


def set_line(case, name):
    outcome = sandglass("mesh", case, "-o", case.parent / "out.h5")
    assert outcome.returncode == 0, outcome.stderr
    return next(line for line in outcome.stdout.splitlines() if f"set {name}:" in line), outcome


@pytest.mark.parametrize(
    "rounded", [lambda z: float(numpy.float32(z)), lambda z: float(f"{z + 4e-7:.6f}")]
)
def test_a_plane_that_was_rounded_is_selected_as_a_whole(tmp_path, rounded):
    (tmp_path / "wobble.inp").write_text(box_mesh(rounded))
    case = tmp_path / "wobble.toml"
    case.write_text(on_mesh("wobble.inp").replace("[0.2, 0.2]", "[0.3, 0.3]"))
    line, outcome = set_line(case, "head")
    assert "9 nodes, surface of 4 faces, x 0 to 0.1, y 0 to 0.1, z" in line
    assert "one plane" not in outcome.stderr


def test_a_rule_that_cuts_a_plane_in_two_is_warned_of(tmp_path):
    """By .1 mm, more than the rounding of a file, with elements of 50 mm."""
    (tmp_path / "cut.inp").write_text(box_mesh(lambda z: z + 1e-4))
    case = tmp_path / "cut.toml"
    case.write_text(on_mesh("cut.inp").replace("[0.2, 0.2]", "[0.3, 0.3]"))
    line, outcome = set_line(case, "head")
    assert "5 nodes" in line
    assert "sets.head selects 5 of 9 nodes between 0.3 and 0.3001 m in z" in outcome.stderr
    case.write_text(case.read_text().replace("[0.3, 0.3]", "[0.3, 0.301]"))
    line, outcome = set_line(case, "head")
    assert "9 nodes" in line and "one plane" not in outcome.stderr


def test_a_rule_that_selects_nothing_says_how_far_the_nearest_node_is(tmp_path):
    case = tmp_path / "far.toml"
    case.write_text(BLOCK.replace("z = [0.2, 0.2]", "z = [0.201, 0.25]"))
    said = refusal(case)
    assert "sets.head selects no node of the 45 of the mesh" in said
    assert "the nearest, 36 at (0, 0, 0.2) m, is 0.001 m outside" in said


def test_mesh_says_what_each_set_is(tmp_path):
    case = tmp_path / "sets.toml"
    more = (
        "rim = { x = [0.0, 0.0], z = [0.2, 0.2] }\n"
        "tips = { x = [0.0, 0.0], y = [0.0, 0.0], z = [0.2, 0.2] }\n"
        "upper = { z = [0.1, 0.2] }\n"
    )
    case.write_text(BARE.replace("head = ", more + "head = "))
    assert set_line(case, "head")[0].endswith(
        "head: 9 nodes, surface of 4 faces, x 0 to 0.1, y 0 to 0.1, z = 0.2 m"
    )
    assert set_line(case, "rim")[0].endswith(
        "rim: 3 nodes, edge, x = 0, y 0 to 0.1, z = 0.2 m; no table uses it"
    )
    assert "tips: 1 node, points, " in set_line(case, "tips")[0]
    assert "upper: 27 nodes, volume of 8 elements, " in set_line(case, "upper")[0]


def test_units_that_do_not_fit_are_warned_of(tmp_path):
    case = tmp_path / "units.toml"
    case.write_text(
        BARE.replace("[0.1, 0.1, 0.2]", "[50, 50, 100]")
        .replace("[0.2, 0.2]", "[100, 100]")
        .replace("[0.02, 0.0, 0.01]", "[2, 0.0, 1]")
    )
    outcome = sandglass("run", case)
    said = " times its Young's modulus, 3 kPa: units are m, Pa and kg/m^3"
    assert "note: a body of 100 m with a density" in outcome.stdout and said in outcome.stdout
