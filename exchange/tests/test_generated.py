"""Some of the files of generated.py, and the answers of the body that they hold."""

import generated
import h5py
import numpy as np
import pytest
from bodies import BODY, Body, lattice
from command_line import sandglass
from writers import KINDS

from common.result_file import last_displacement

CASE = """\
[case]
name = "body"
requirement = "the same answer, whatever program wrote the mesh"
answer = "quasi-static"
[mesh]
file = "{}"
[[materials]]
elements = "stiff"
law = "neo-hookean"
young_modulus = 30000.0
poisson_ratio = 0.3
density = 1000.0
[[materials]]
law = "neo-hookean"
young_modulus = 3000.0
poisson_ratio = 0.3
density = 1000.0
[[displacement]]
set = "{}foot"
value = [0.0, 0.0, 0.0]
[[force]]
set = "head"
total = [0.1, 0.0, 0.2]
"""


def skip_without_nibabel(name):
    if "nifti" in name:
        pytest.importorskip("nibabel")


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", KINDS)
def test_a_file_gives_the_body_or_is_refused(tmp_path, name, seed):
    skip_without_nibabel(name)
    assert generated.check(tmp_path, seed, name) == ""


def test_mutilated_files_are_refused_or_valid(tmp_path):
    """A digit of a coordinate that changes, or two lines of a list that change places, leave a
    valid file of another body: no more than one in 25."""
    pytest.importorskip("nibabel")
    found = generated.mutilate(tmp_path, 500, 2)
    assert not [result for result in found if "WRONG" in str(result)], found
    assert found[2] > 400 and found[2] + found[0] > 480, found


@pytest.mark.parametrize("ending", [".msh", ".inp"])
def test_a_byte_order_mark_is_no_part_of_a_file(tmp_path, ending):
    """Editors of Windows write it."""
    name = {".msh": "gmsh 2.2", ".inp": "inp flat"}[ending]
    data, body = KINDS[name][1](np.random.default_rng(1))
    path = tmp_path / ("body" + ending)
    path.write_bytes(b"\xef\xbb\xbf" + data.removeprefix(b"\xef\xbb\xbf").replace(b"\n", b"\r\n"))
    code, said, _, found = generated.read(path)
    assert code == 0 and generated.difference(found, body) == "", said


def answer(folder, mesh, scope=""):
    """(strain energy, displacements of three corners)."""
    (folder / "case.toml").write_text(CASE.format(mesh, scope))
    done = sandglass("run", folder / "case.toml", "-o", folder / "a.h5", "-m", "tl-mean-dilatation")
    assert done.returncode == 0, done.stderr
    with h5py.File(folder / "a.h5") as file:
        points, energy = file["mesh/points"][...], file["history/strain_energy"][-1]
    corners = BODY.points[[3, 20, 35]]
    nodes = [np.linalg.norm(points - corner, axis=1).argmin() for corner in corners]
    return energy, last_displacement(folder / "a.h5")[nodes]


def test_the_program_gives_one_answer_for_all_formats(tmp_path):
    """To the tolerance of 1e-8 of equilibrium; coordinates in float move by 6e-8 of their size."""
    energies, motions = [], []
    for name, (ending, write, message) in KINDS.items():
        data, body = write(np.random.default_rng(5))
        if message or "nifti" in name:
            continue
        (tmp_path / f"body{ending}").write_bytes(data)
        energy, motion = answer(tmp_path, f"body{ending}", "Assembly." if "same" in name else "")
        energies.append(energy)
        motions.append(motion)
    size = np.abs(motions[0]).max()
    assert np.ptp(energies) < 1e-5 * energies[0] and np.ptp(motions, axis=0).max() < 1e-5 * size


def cube(comma=""):
    """(nodes on z = 0, nodes on z = .1, lines of *NODE and *ELEMENT) of 8 elements, .1 m wide."""
    at, cells = lattice(np.argwhere(np.ones((2, 2, 2))))
    lines = ["*Node", *(f"{n}, {x}, {y}, {z}{comma}" for n, (x, y, z) in enumerate(at * 0.05, 1))]
    rows = [", ".join(map(str, row)) for row in np.column_stack([np.arange(101, 109), cells + 1])]
    lines += ["*Element, type=C3D8", *(row + comma for row in rows)]
    return *(np.flatnonzero(at[:, 2] == z) + 1 for z in (0, 2)), lines


def energy_of(folder, lines, head, scope="", load="force", code=0):
    """The strain energy of a cube that is loaded in z; or what is said of a code of 2."""
    (folder / "cube.inp").write_text("\n".join([*lines, ""]))
    start, end = CASE.index("[[materials]]"), CASE.rindex("[[materials]]")
    text = CASE[:start] + "[material]" + CASE[end:].removeprefix("[[materials]]")
    text = text.format("cube.inp", scope).replace('foot"', 'Set-1"').replace('"head"', f'"{head}"')
    text = text[: text.rindex("[[force]]")] + (
        f'[[force]]\nset = "{head}"\ntotal = [0.0, 0.0, 1.0]\n'
        if load == "force"
        else f'[[displacement]]\nset = "{head}"\nvalue = [0.0, 0.0, 0.01]\n'
    )
    (folder / "case.toml").write_text(text)
    done = sandglass("run", folder / "case.toml", "-o", folder / "a.h5", code=code)
    if code:
        return done.stderr
    with h5py.File(folder / "a.h5") as file:
        return file["history/strain_energy"][-1]


def listed(name, nodes):
    return [f"*Nset, nset={name}", *(f"{n}," for n in nodes)]


def test_a_set_of_a_part_is_not_that_of_the_assembly(tmp_path):
    """Abaqus/CAE calls both Set-1: joined, they held every node. The energy is that of the same
    file with another name."""
    foot, head, lines = cube()
    lines = ["*Part, name=Cube", *lines, "*Nset, nset=Set-1, generate", "1, 27, 1", "*End Part"]
    lines += ["*Assembly, name=Assembly", "*Instance, name=Cube-1, part=Cube", "*End Instance"]
    for name, nodes in (("Set-1", foot), ("Set-2", head)):
        lines += [
            line.replace("=" + name, f"={name}, instance=Cube-1") for line in listed(name, nodes)
        ]
    said = energy_of(tmp_path, lines, "Set-2", code=2)
    message = (
        "'Set-1' means several sets of the file: write 'Assembly.Set-1' (9) or 'Cube-1.Set-1' (27)"
    )
    assert message in said
    assert energy_of(tmp_path, lines, "Set-2", "Assembly.") == pytest.approx(0.00164435, rel=3e-6)


@pytest.mark.parametrize("comma", ["", ","])
def test_a_comma_at_the_end_of_a_line_continues_nothing(tmp_path, comma):
    """Lines of four membranes were joined: 12 nodes, among them those of numbers of elements."""
    foot, head, lines = cube(comma)
    square = {tuple(c[:2]): n for n, c in zip(head, np.argwhere(np.ones((3, 3))))}
    lines += ["*Element, type=M3D4, elset=SKIN"]
    for number, (i, j) in enumerate(np.ndindex(2, 2), 10):
        quad = [square[i, j], square[i + 1, j], square[i + 1, j + 1], square[i, j + 1]]
        lines.append(", ".join(map(str, [number, *quad])) + comma)
    lines += listed("Set-1", foot)
    energy = energy_of(tmp_path, lines, "SKIN", load="displacement")
    assert energy == pytest.approx(0.0148756, rel=3e-6)


def test_the_comparison_sees_what_is_misread():
    """Of a body with one node moved, one set short of a node, one element of the other material."""
    parts = BODY.points, BODY.cells, BODY.sets, BODY.element_sets
    assert sorted(map(len, BODY.sets.values())) == [9, 9, 12]
    assert generated.difference(BODY, BODY) == ""
    moved = BODY.points.copy()
    moved[0, 0] += 1e-6
    short = BODY.sets | {"foot": BODY.sets["foot"][1:]}
    other = BODY.element_sets | {"stiff": BODY.element_sets["stiff"][1:]}
    for place, bad in (
        (0, moved),
        (1, BODY.cells[:, [0, 1, 2, 3, 4, 5, 6, 0]]),
        (2, short),
        (3, other),
    ):
        assert generated.difference(Body(*parts[:place], bad, *parts[place + 1 :]), BODY) != ""
