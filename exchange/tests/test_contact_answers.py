"""Contact in decks for CalculiX: what ccx finds, beside closed forms and our answers."""

import shutil
from dataclasses import replace

import h5py
import numpy as np
import pytest
from command_line import ran, sandglass
from scipy.optimize import brentq
from test_deck_contact import obstacle
from test_decks import NEO_HOOKEAN, problem

from common.hexahedron import CUBE, boundary_faces
from common.result_file import last_displacement
from exchange import decks, frd_file, matching
from exchange.decks import rigid_surface
from exchange.decks.contact import Pair
from exchange.foreign_mesh import HexMesh

needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="ccx is not installed")

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
@pytest.mark.parametrize("case, edge", [("hertz-8", 0.025), ("hertz-4", 0.05)])
def test_ccx_finds_the_force_of_hertz_case(case, edge, tmp_path):
    """In ccx the faces of the body touch, not its nodes: in the middle of a face the ball is deeper
    by the sagitta of its diagonal. Chords of the ball, and its sinking in by pressure over
    stiffness, make it less deep. The force grows with the depth to the power of 1.5 (cases/hertz).
    """
    (own, _), (found, _) = both_answers(case, tmp_path)
    depth, radius = 1e-3, 10.0
    deeper = 2 * edge**2 / (8 * radius)
    sunk = 9.549e4 / (30 * 14_062_500 / edge)  # pressure over stiffness
    less = rigid_surface.CHORD * depth + sunk
    ratio = found[2] / own[2]
    assert (1 - less / depth) ** 1.5 < ratio < (1 + deeper / depth) ** 1.5
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
