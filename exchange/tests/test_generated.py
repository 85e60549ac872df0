"""Some of the files of generated.py, and the answers of the body that they hold."""

from collections import Counter

import generated
import h5py
import numpy as np
import pytest
from command_line import sandglass

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


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", [*generated.KINDS, "nifti"])
def test_a_file_gives_the_body_or_is_refused(tmp_path, name, seed):
    if name == "nifti":
        pytest.importorskip("nibabel")
    assert generated.check(tmp_path, seed, name) == ""


def test_mutilated_files_are_read_or_refused(tmp_path):
    pytest.importorskip("nibabel")
    found = generated.mutilate(tmp_path, 260, 2)
    assert set(found) <= {0, 2} and found[2] > 100, found


def answer(folder, mesh, scope=""):
    """(strain energy, displacements of three corners)."""
    (folder / "case.toml").write_text(CASE.format(mesh, scope))
    done = sandglass("run", folder / "case.toml", "-o", folder / "a.h5", "-m", "tl-mean-dilatation")
    assert done.returncode == 0, done.stderr
    with h5py.File(folder / "a.h5") as file:
        points, energy = file["mesh/points"][...], file["history/strain_energy"][-1]
    corners = generated.BODY.points[[3, 20, 35]]
    nodes = [np.linalg.norm(points - corner, axis=1).argmin() for corner in corners]
    return energy, last_displacement(folder / "a.h5")[nodes]


def test_the_program_gives_one_answer_for_all_formats(tmp_path):
    """To the tolerance of 1e-8 of equilibrium; coordinates in float move by 6e-8 of their size."""
    energies, motions = [], []
    for name in [name for name, (_, _, told) in generated.KINDS.items() if not told]:
        if name == "vtu of voxels":  # of a bent body: as good as any
            continue
        ending, content, _ = generated.KINDS[name]
        (tmp_path / f"body{ending}").write_bytes(content(np.random.default_rng(5)))
        scope = "Assembly." if name == "inp same name" else ""
        energy, motion = answer(tmp_path, f"body{ending}", scope)
        energies.append(energy)
        motions.append(motion)
    size = np.abs(motions[0]).max()
    assert np.ptp(energies) < 1e-5 * energies[0] and np.ptp(motions, axis=0).max() < 1e-5 * size


def test_a_name_of_several_sets_is_refused_where_it_is_used(tmp_path):
    content = generated.KINDS["inp same name"][1](np.random.default_rng(5))
    (tmp_path / "body.inp").write_bytes(content)
    (tmp_path / "case.toml").write_text(CASE.format("body.inp", ""))
    done = sandglass("run", tmp_path / "case.toml", "-o", tmp_path / "a.h5")
    told = (
        "= 'foot' means several sets of the file: write 'Assembly.foot' (9) or 'Body-1.foot' (36)"
    )
    assert done.returncode == 2 and told in done.stderr, done.stderr


def test_the_comparison_sees_what_is_misread():
    """Of a body with one node moved, one set short of a node, one element of the other material."""
    body = generated.BODY
    sets = {k: v for k, v in body.sets.items()}
    assert Counter(len(v) for v in sets.values()) == {9: 2, 12: 1}
    good = body.points, body.cells, sets, body.element_sets
    assert generated.difference(good, "vtu") == ""
    moved = body.points.copy()
    moved[0, 0] += 1e-6
    short = sets | {"foot": sets["foot"][1:]}
    other = body.element_sets | {"stiff": body.element_sets["stiff"][1:]}
    for bad in (
        (moved, *good[1:]),
        (*good[:2], short, good[3]),
        (*good[:3], other),
        (good[0], body.cells[:, [0, 1, 2, 3, 4, 5, 6, 0]], *good[2:]),
    ):
        assert generated.difference(bad, "vtu") != ""
