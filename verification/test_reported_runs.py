"""Runs reported by users or found in random scenes: right answers are accepted, wrong ones refused,
and every run ends. The inputs are in reported/."""

import re
import signal

import h5py
import numpy
import pytest
from command_line import interrupted, sandglass

from common.program import ROOT
from common.result_file import last_displacement, text_of

FOLDER = ROOT / "verification" / "reported"


def run(name, tmp_path, *options, code=0, **replaced):
    """A case of the folder with some lines replaced; its outcome and its result file.

    code: the expected exit code; None: any.
    """
    for mesh in FOLDER.glob("*.inp"):
        (tmp_path / mesh.name).write_bytes(mesh.read_bytes())
    text = (FOLDER / f"{name}.toml").read_text()
    for old, new in replaced.get("lines", {}).items():
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "case.toml").write_text(text + replaced.get("more", ""))
    result = tmp_path / "result.h5"
    return sandglass("run", tmp_path / "case.toml", "-o", result, *options, code=code), result


def evaluations(outcome):
    return int(re.search(r"(\d+) evaluation", outcome.stdout).group(1))


def points(result):
    with h5py.File(result) as file:
        return file["mesh/points"][:]


def turned(x):
    """Rotated by 90 degrees about the x axis through the middle of the bar."""
    y, z = x[:, 1] - 0.05, x[:, 2] - 0.15
    return numpy.stack([x[:, 0], 0.05 - z, 0.15 + y], axis=1) - x


RIGID = {
    "shift": lambda x: numpy.broadcast_to([0.01, 0.0, 0.0], x.shape),
    "seam": lambda x: numpy.outer(x[:, 2] > 0.15, [0.0, 0.0, 0.02]),
    "turn-x-90": turned,
}


@pytest.mark.parametrize("precision, digits", [("double", 1e-12), ("float", 1e-5)])
@pytest.mark.parametrize("method", ["tl-perturbation", "tl-enhanced", "tl-mean-dilatation", "t4"])
@pytest.mark.parametrize("name", ["shift", "turn-x-90"])
def test_a_body_that_is_moved_as_a_whole_rests(name, method, precision, digits, tmp_path):
    """Digits: those of rounding, times the number of elements and their condition number."""
    outcome, result = run(name, tmp_path, "--method", method, "--precision", precision)
    assert evaluations(outcome) < (400 if method == "t4" else 60)
    u, x = last_displacement(result), points(result)
    assert abs(u - RIGID[name](x)).max() < digits * abs(u).max()


@pytest.mark.parametrize("precision", ["double", "float"])
def test_two_parts_that_share_no_node_rest(precision, tmp_path):
    outcome, result = run("seam", tmp_path, "--precision", precision)
    assert evaluations(outcome) < 30
    x = points(result)
    upper = numpy.arange(len(x)) >= 8
    assert abs(last_displacement(result)[:, 2] - 0.02 * upper).max() < 1e-7


def test_a_small_load_on_a_body_that_is_moved_is_not_taken_for_rounding(tmp_path):
    """It moves the middle by about 1e-9 of the shift, seven orders above the shift's rounding."""
    pushed = """
[[force]]
set = "middle"
total = [0.0, 1e-10, 0.0]
on = "nodes"
"""
    sets = {"[sets]": "[sets]\nmiddle = { x = [0.05, 0.05], y = [0.05, 0.05], z = [0.05, 0.05] }"}
    held = dict(sets, **{"value = [0.01, 0.0, 0.0]": "value = [0.0, 0.0, 0.0]"})
    _, result = run("shift", tmp_path, lines=sets, more=pushed)
    u = last_displacement(result)[:, 1]
    _, result = run("shift", tmp_path, lines=held, more=pushed)
    right = last_displacement(result)[:, 1]
    assert 0.0 < abs(right).max() < 1e-9
    assert abs(u - right).max() < 1e-4 * abs(right).max()


@pytest.mark.parametrize(
    "name, force, digits, most",
    [("planar-force", 16.815492096, 1e-6, 120), ("biaxial-mooney", 29.07063936, 1e-4, 3000)],
)
def test_next_to_incompressible_rubber_rests(name, force, digits, most, tmp_path):
    """K / mu up to 6e7: a stretch of 5 without change of volume. Digits: stress over K. One element
    took 287 evaluations when steps were combined beyond the rounding of single precision: it has
    fewer unknowns than steps are stored."""
    outcome, result = run(name, tmp_path)
    assert f"{force:.3g}" in outcome.stdout
    right = points(result)[:, 0] == 1.0
    assert abs(last_displacement(result)[right, 0] - 4.0).max() < 4.0 * digits
    assert evaluations(outcome) < most


@pytest.mark.parametrize("name", ["planar-force", "biaxial-mooney"])
def test_a_wrong_answer_is_not_within_the_rounding_of_single_precision(name, tmp_path):
    """Rounding times K is more than these bodies bear in single precision."""
    outcome, result = run(
        name,
        tmp_path,
        "--precision",
        "float",
        code=None,
        more="\n[relaxation]\nmax_steps = 20000\n",
    )
    right = points(result)[:, 0] == 1.0
    good = abs(last_displacement(result)[right, 0] - 4.0).max() < 0.04
    assert good or outcome.returncode == 3


@pytest.mark.parametrize(
    "elements, bulk, apex",
    [
        (2, 20000, -8.8477),  # the golden's: reference/solve.py
        (4, 20000, -8.870),  # FEniCSx on another mesh of as many elements
        (8, 20000, -8.82),  # Land et al. 2015, to .5 % of the position, -27.32
        (2, 2000, None),
        (2, 200, None),
        (4, 2000, None),
        (4, 200, None),
    ],
)
def test_an_inflated_ventricle_rests_soon(elements, bulk, apex, tmp_path):
    """Problem 2 of Land et al. 2015, once not solved by 100,000 evaluations. Meshes with equally
    many elements differ by .1 % of the displacement; softer muscle deforms further."""
    sizes = {2: (6, 9, 2), 4: (12, 18, 4), 8: (24, 36, 8)}[elements]
    text = (ROOT / "cases" / "ventricle.toml").read_text().split("[[variants")[0]
    keys = zip(("core_elements", "rings", "layers"), sizes)
    text = text.replace("rim = 5.0\n", "rim = 5.0\n" + "".join(f"{k} = {n}\n" for k, n in keys), 1)
    text = text.replace("bulk_modulus = 20000.0", f"bulk_modulus = {bulk}.0")
    (tmp_path / "case.toml").write_text(text)
    result = tmp_path / "result.h5"
    outcome = sandglass("run", tmp_path / "case.toml", "-o", result, code=0)
    assert evaluations(outcome) <= 300
    with h5py.File(result) as file:
        found = last_displacement(result)[file["mesh/sets/apex"][0], 2]
    if apex is None:
        assert -12.0 < found < -8.9
    else:
        tolerance = {2: 1e-4, 4: 0.002 * 8.87, 8: 0.005 * 27.32}[elements]
        assert abs(found - apex) < tolerance


def test_a_clamped_strip_rests(tmp_path):
    """Six elements, whose load never grew: nodes of the coarsest grid outside of all samples were
    moved by a million times too much."""
    outcome, result = run("strip", tmp_path)
    assert evaluations(outcome) < 300
    u = last_displacement(result)
    _, result = run("strip", tmp_path, lines={"[relaxation]": "[relaxation]\nlevels = 20"})
    assert abs(u - last_displacement(result)).max() < 1e-6 * abs(u).max()
    small, result = run("strip", tmp_path, lines={"0.001": "1e-9"})
    assert evaluations(small) < 40


def test_the_largest_number_of_evaluations_is_kept_to(tmp_path):
    lines = {"[relaxation]": "[relaxation]\nmax_steps = 9"}
    outcome, _ = run("strip", tmp_path, code=3, lines=lines)
    assert "no equilibrium after" in outcome.stderr and evaluations(outcome) <= 17
    assert not list(tmp_path.glob("*.part"))


@pytest.mark.parametrize("levels", [0, 20, 50])
def test_levels_that_forces_remember_are_solved(levels, tmp_path):
    """Levels in equilibrium: the end moves as with many levels, to the 2 % of the path's influence.
    One level was accepted with a residual of 1.3, and the end moved by a quarter less."""
    lines = {"[relaxation]": f"[relaxation]\nlevels = {levels}"}
    outcome, result = run("arc", tmp_path, "--method", "ul-perturbation", lines=lines)
    largest = numpy.linalg.norm(last_displacement(result), axis=1).max()
    assert largest == pytest.approx(0.0413, rel=0.02)


def test_the_first_load_does_not_depend_on_the_orientation(tmp_path):
    """It follows from lengths and volumes, which a rotation changes only by rounding."""
    a, b = numpy.cos(0.7), numpy.sin(0.7)
    turn = numpy.array([[a, -b, 0.0], [b, a, 0.0], [0.0, 0.0, 1.0]]) @ [
        [a, 0, b],
        [0, 1, 0],
        [-b, 0, a],
    ]
    first = []
    for rotation in numpy.eye(3), turn:
        lines = (FOLDER / "arc.inp").read_text().splitlines()
        start, end = lines.index("*NODE") + 1, lines.index("*ELEMENT, TYPE=C3D8")
        for n in range(start, end):
            number, *x = lines[n].split(",")
            lines[n] = ", ".join(
                [number, *(repr(float(v)) for v in rotation @ numpy.array(x, float))]
            )
        (tmp_path / "turned.inp").write_text("\n".join(lines) + "\n")
        text = (FOLDER / "arc.toml").read_text().replace("arc.inp", "turned.inp")
        for total in re.findall(r"total = \[(.*)\]", text):
            force = rotation @ numpy.array(total.split(","), float)
            text = text.replace(total, ", ".join(repr(float(v)) for v in force))
        (tmp_path / "case.toml").write_text(text)
        result = tmp_path / "result.h5"
        sandglass(
            "run", tmp_path / "case.toml", "-o", result, "--method", "ul-perturbation", code=0
        )
        with h5py.File(result) as file:
            first.append(file["history/step_size"][1])
    assert first[0] == pytest.approx(first[1], rel=1e-9)


def test_a_step_that_collapses_is_reported(tmp_path):
    outcome, _ = run("collapse", tmp_path, "--method", "t4", code=3)
    assert re.search(
        r"the stable step has collapsed at 0\.0\d+ s, step \d+: element \d+ allows", outcome.stderr
    )
    assert not list(tmp_path.glob("*.part"))


SETTLING = """
[case]
name = "settling"
requirement = "a block settles on a plane"
answer = "dynamic"
[mesh]
generator = "box"
size = [0.1, 0.1, 0.1]
elements = [3, 3, 3]
[material]
law = "neo-hookean"
young_modulus = 1e5
poisson_ratio = 0.3
density = 1000.0
[sets]
base = { z = [0.0, 0.0] }
[[obstacle]]
name = "floor"
set = "base"
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
[[gravity]]
value = [0.0, 0.0, -9.81]
[dynamics]
duration = 3.0
ramp_time = 0.5
damping = 20.0
"""


def test_a_body_that_settles_in_contact_keeps_its_balance(tmp_path):
    """Contact moves nodes between half steps, whose product may be below zero at rest: summed as a
    loss by damping, it was -56 %. Allowed: 2 %, as the loss is summed from rows of the history."""
    (tmp_path / "settling.toml").write_text(SETTLING)
    outcome = sandglass("run", "settling.toml", cwd=tmp_path)
    assert abs(float(re.search(r"energy balance: ([-+.e\d]+) %", outcome.stdout)[1])) < 2.0


def test_a_soft_contact_is_noticed(tmp_path):
    """The block sinks in by rho g L / (E p) of an edge: 3 % with p = .3, a hundredth of that by
    default. The kinematic method keeps it out."""
    for penalty, warns in (0.3, True), (30.0, False), (None, False):
        lines = f'method = "penalty"\npenalty = {penalty}\n' if penalty else ""
        (tmp_path / "soft.toml").write_text(SETTLING.replace("[[gravity]]", lines + "[[gravity]]"))
        outcome = sandglass("run", "soft.toml", cwd=tmp_path)
        assert ("deep in contact, above 1 %" in outcome.stderr) == warns
        assert ('or take method = "kinematic"' in outcome.stderr) == warns


def test_several_materials_conserve_energy(tmp_path):
    """At steps of a fifth, only the second-order error remains. It was 4.5 % for t4-anp."""
    for method in ("t4-anp", "t4", "tl-four-point"):
        outcome, _ = run("layers", tmp_path, "--method", method)
        balance = re.search(r"energy balance: ([-+.e\d]+) %", outcome.stdout)
        assert abs(float(balance.group(1))) < 0.1


@pytest.mark.parametrize("method", ["t4-anp", "tl-four-point", "tl-perturbation"])
def test_equal_materials_are_one(method, tmp_path):
    """The answer does not depend on the division into materials, or on the order of elements."""
    same = {"poisson_ratio = 0.3": "poisson_ratio = 0.49"}
    _, result = run("layers", tmp_path, "--method", method, lines=same)
    parts = last_displacement(result)
    text = (FOLDER / "layers.toml").read_text()
    first = text.index("[[materials]]")
    second = text.index("[[materials]]", first + 1)
    one = text[:first] + text[second:].replace("[[materials]]", "[material]", 1)
    one = re.sub(r"\[element_sets\]\n.*\n", "", one)
    (tmp_path / "one.toml").write_text(one)
    sandglass("run", tmp_path / "one.toml", "-o", tmp_path / "one.h5", "--method", method, code=0)
    # Sums in another order, over a few hundred steps.
    assert numpy.abs(last_displacement(tmp_path / "one.h5") - parts).max() < 1e-10


def end_of(result):
    """The mean displacement of the nodes at the end."""
    with h5py.File(result) as file:
        return last_displacement(result)[file["mesh/sets/end"][:]].mean(axis=0)


ELASTICA = {"elastica-1152": (-0.259, 0.593), "elastica-1884": (-0.877, 0.803)}


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize(
    "method", ["tl-perturbation", "tl-enhanced", "tl-assumed-strain", "tl-mean-dilatation"]
)
@pytest.mark.parametrize("name", ELASTICA)
def test_a_column_beyond_its_buckling_load_is_an_elastica(name, method, precision, tmp_path):
    """The table of Timoshenko and Gere. The search may find the straight column first. Tolerance:
    error of the mesh, two elements across; with eight points they are about 4 % too stiff in
    bending, as if the load were smaller by as much, and rows of the table are .09 and .17 apart. In
    single precision rounding is as large as the side force and the least eigenvalue: it decides the
    plane in which a column of square section bends."""
    outcome, result = run(name, tmp_path, "--method", method, "--precision", precision)
    with h5py.File(result) as file:
        stability = text_of(file.attrs["stability"])
    assert f"static equilibrium ({stability})" in outcome.stdout
    rounded = precision == "float" and "may be rounding" in stability
    assert stability.startswith("stable") or rounded
    x, y, z = end_of(result)
    if precision == "float":
        y = numpy.hypot(y, z)
    tolerance = 0.07 if method == "tl-mean-dilatation" else 0.01 if precision == "double" else 0.02
    assert abs(numpy.subtract((x, y), ELASTICA[name])).max() < tolerance


def test_a_column_bends_to_the_side_of_its_load(tmp_path):
    """Its answer is the end of a damped motion; an unstable equilibrium is found first."""
    outcome, result = run("column", tmp_path)
    assert "static equilibrium (stable, reached from an unstable one)" in outcome.stdout
    motion = """
[dynamics]
duration = 60.0
ramp_time = 10.0
damping = 3.0
frames = 2
"""
    lines = {'answer = "quasi-static"': 'answer = "dynamic"'}
    answer = end_of(result)
    assert abs(answer[:2] - (-0.245, 0.580)).max() < 5e-4
    _, result = run("column", tmp_path, lines=lines, more=motion)
    assert abs(answer - end_of(result)).max() < 1e-4


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_search_leaves_no_partial_file(sent, tmp_path):
    text = (FOLDER / "turn-x-90.toml").read_text().replace("[2, 2, 6]", "[30, 30, 90]")
    (tmp_path / "case.toml").write_text(text)
    words = ("run", "case.toml", "-o", "result.h5", "--method", "tl-full")
    code, _ = interrupted(
        *words, sent=sent, once=lambda: list(tmp_path.glob("*.part")), cwd=tmp_path
    )
    assert code == 3
    assert not list(tmp_path.glob("*.part"))
