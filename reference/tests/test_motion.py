"""Goldens of motion: exact motions for the integrator, and a small golden for the solver."""

import json
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from command_line import ran

import solve
from blocks import distorted_block, write_mesh
from case_file import Material, Motion, read_case
from common.errors import InputError
from common.program import ROOT, binary
from hexahedra import Condition, HexMesh, traction
from mesh_file import initial_velocity, load_case_mesh, make_mesh
from motion import integrate, solve_motion
from reference_file import MOTION_ATTRIBUTES, read_reference

ELEMENTS, LENGTH, SPEED = 6, 1.0, 1e-6
BAR = Material("neo-hookean", {"young_modulus": 3.0, "poisson_ratio": 0.0}, 2.0)

SMALL = Path(__file__).with_name("small.toml.in").read_text()


def _bar():
    """A bar of one element across that starts in its first axial mode, as bar-wave.toml."""
    z = np.linspace(0, LENGTH, ELEMENTS + 1)
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * 0.1
    points = np.array([(x, y, height) for height in z for x, y in square])
    cells = np.array([np.arange(8) + 4 * k for k in range(ELEMENTS)])
    velocity = np.zeros_like(points)
    velocity[:, 2] = SPEED * np.cos(np.pi * points[:, 2] / LENGTH)
    return HexMesh(points, cells, ()), velocity


def _frequency():
    """Of the bar's first mode with linear elements and lumped masses, rad/s, exact."""
    h, c = LENGTH / ELEMENTS, np.sqrt(3.0 / 2.0)
    return 2 * c / h * np.sin(np.pi * h / 2 / LENGTH)


@pytest.mark.parametrize("damping", [0.0, 0.7])
def test_steps_are_those_of_the_trapezoidal_rule(damping):
    mesh, velocity = _bar()
    motion, steps = Motion(2.0, 1.0, damping, 4), 5
    found, _ = integrate(mesh, [BAR], motion, velocity, steps)
    # The mode by itself, y = (u, v): y' = A y, so (1 - h/2 A) y_new = (1 + h/2 A) y.
    a = np.array([[0, 1], [-_frequency() ** 2, -damping]]) * motion.duration / 4 / steps / 2
    step = np.linalg.solve(np.eye(2) - a, np.eye(2) + a)
    for frame, u in enumerate(found, start=1):
        amplitude = (np.linalg.matrix_power(step, frame * steps) @ [0, SPEED])[0]
        # Strains are 3e-6, which is how far the law is from Hooke's; the amplitude is 3e-7.
        assert np.abs(u - amplitude * velocity / SPEED).max() < 1e-5 * SPEED / _frequency()


def test_extrapolated_motion_is_as_accurate_as_its_estimate():
    mesh, velocity = _bar()
    motion = Motion(3.0, 1.0, 0.7, 3)
    golden = solve_motion(mesh, [BAR], motion, velocity)
    w = np.sqrt(_frequency() ** 2 - 0.35**2)
    exact = np.exp(-0.35 * motion.times()) * np.sin(w * motion.times()) / w
    errors = np.abs(golden.displacement - exact[:, None, None] * velocity).max() / golden.unit
    # A scheme of fourth order: the last halving left a fifteenth of what it changed.
    assert errors < 0.2 * golden.halving[0] + 1e-5
    assert golden.halving[0] < 1e-4


def test_imposed_displacement_and_masses():
    points, cells, _ = distorted_block(n=2)
    moved = Condition(points[:, 0] > -1, (0, 1, 2), np.tile((0.0, 0.0, 0.1), (len(points), 1)))
    motion = Motion(1.0, 0.5, 0.0, 4)
    found, _ = integrate(HexMesh(points, cells, (moved,)), [BAR], motion, 0 * points, 1)
    # Eq. 15 at a half of the ramp is a half; from its end on, one.
    assert np.abs(found[:, :, 2] - 0.1 * np.array([0.5, 1, 1, 1])[:, None]).max() < 1e-15


def test_a_pulse_leaves_its_impulse():
    """A free bar that is pushed along its curve, 0, 1, 0 at 0, 1, 2 s, flies on with 1 N s."""
    mesh, _ = _bar()
    push = 1e-9
    load = traction(mesh.points, mesh.cells, mesh.points[:, 2] == LENGTH, (0, 0, push), (0, 0, 0))
    mesh = replace(
        mesh, tractions=(replace(load, curve=lambda t: np.interp(t, (0, 1, 2), (0, 1, 0))),)
    )
    motion = Motion(4.0, 1.0, 0.0, 4)
    found, _ = integrate(mesh, [BAR], motion, np.zeros_like(mesh.points), 8)
    masses = np.repeat([0.5, *[1] * (ELEMENTS - 1), 0.5], 4) / ELEMENTS / 4
    # The rule integrates linear functions of time exactly; round-off of forces of 1e-9 beside 3 Pa.
    flown = masses @ (found[3] - found[2])[:, 2]
    assert flown * 2.0 * 0.01 * LENGTH == pytest.approx(push, rel=1e-5)


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """A function from replacements in the small case's text to its folder, with a golden in it."""

    def make(*changes, golden_of=None):
        folder = tmp_path_factory.mktemp("small")
        text = SMALL
        for old, new in (*changes, ("TIME_STEP", "1e-3"), ("BELOW", "1e-2")):
            text = text.replace(old, new)
        (folder / "small.toml").write_text(text)
        if golden_of is None:
            make_mesh(folder / "small.toml", folder / "mesh.h5")
            command = ["motion", folder / "small.toml", "--mesh", folder / "mesh.h5"]
            assert solve.main([*map(str, command), "-o", str(folder / "golden.h5")]) == 0
        else:
            (folder / "golden.h5").write_bytes((golden_of / "golden.h5").read_bytes())
        return folder

    return make


@pytest.fixture(scope="module")
def plain(small):
    """The folder of the small case as it is."""
    return small()


def _verify(folder):
    """(exit code, error of tl-mean-dilatation, text) of `sandglass verify`."""
    command = [binary(), "verify", folder / "small.toml", "--json", folder / "v.json"]
    run = ran(*command, cwd=ROOT)
    if run.returncode not in (0, 1):
        return run.returncode, None, run.stderr
    records = json.loads((folder / "v.json").read_text())["records"]
    record = next(r for r in records if r["method"] == "tl-mean-dilatation")
    return run.returncode, record["golden"]["max_relative_error"], run.stdout


def test_golden_has_its_times_and_figures(plain):
    points, displacement, attributes = read_reference(plain / "golden.h5")
    assert np.allclose(attributes["times"], 0.02 * np.arange(1, 7), rtol=1e-15)
    assert displacement.shape == (6, *points.shape) and attributes["kind"] == "motion"
    assert all(attributes[name] < 1e-4 for name in MOTION_ATTRIBUTES)
    largest = np.linalg.norm(displacement, axis=2).max()
    assert attributes["largest_imposed"] == pytest.approx(largest, rel=1e-12)


def test_solver_converges_to_the_golden_with_the_square_of_its_step(small, plain):
    errors = []
    # Whole parts of the frames, with errors from 1e-3 to 1e-4, far above the golden's own.
    for step in ("4e-3", "2e-3", "1e-3"):
        code, error, text = _verify(small(("TIME_STEP", step), golden_of=plain))
        assert code == 0, text
        errors.append(error)
    # The largest error over time is at the same place for all steps; the next power of the step
    # and the golden's own error, below 1e-4 / 15, change the ratio of 4 by a tenth at most.
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(4, rel=0.15)


def _changed(path, change):
    """Applies a function to the displacements of a stored motion, frame by frame."""
    with h5py.File(path, "r+") as file:
        frames = [file[f"displacement/{n:04}"] for n in range(1, 1 + len(file["times"]))]
        for frame, values in zip(frames, change([frame[...] for frame in frames])):
            frame[...] = values


def test_a_motion_that_is_a_step_late_breaks_the_limit(small, plain):
    """The limit is three times the error of the step; one step late is far beyond."""
    _, error, _ = _verify(plain)
    folder = small(("BELOW", f"{3 * error}"), golden_of=plain)
    assert _verify(folder)[0] == 0
    share = 1e-3 / 0.02  # of a frame
    late = lambda u: [a + share * (b - a) for a, b in zip(u, u[1:])] + u[-1:]  # noqa: E731
    _changed(folder / "golden.h5", late)
    assert _verify(folder)[0] == 1


@pytest.mark.parametrize(
    "change",
    [
        ("density = 1000.0", "density = 1100.0"),
        ("= 5.0", "= 6.0"),
        ("total = 0.004", "total = 0.005"),
        ("factors = [0.0, 1.0]", "factors = [0.0, 0.9]"),
    ],
)
def test_golden_of_another_motion(small, plain, change):
    """It is refused because of its hash; with a forged hash it breaks the limit."""
    folder = small(change, golden_of=plain)
    code, _, text = _verify(folder)
    assert code == 2 and "case_hash" in text and "reference/regenerate small" in text
    make_mesh(folder / "small.toml", folder / "mesh.h5")
    with h5py.File(folder / "golden.h5", "r+") as file, h5py.File(folder / "mesh.h5") as mesh:
        file.attrs["case_hash"] = mesh.attrs["case_hash"]
    _, error, _ = _verify(plain)
    assert _verify(folder)[1] > 3 * error


def test_other_frames_are_refused(small, plain):
    code, _, text = _verify(small(("frames = 6", "frames = 5"), golden_of=plain))
    assert code == 2 and "6 times" in text


def test_initial_velocity_and_curves_of_a_case(tmp_path):
    text = SMALL.replace("TIME_STEP", "0").replace("BELOW", "1")
    text += "[[velocity]]\nvalue = [0.0, 0.0, 2.0]\nhalf_waves = [0, 0, 1]\n"
    text += '[[velocity]]\nset = "head"\nvalue = [1.0, 0.0, 0.0]\n'
    text += '[[force]]\nset = "head"\ntimes = [0.0, 0.1]\nfactors = [0.0, 2.0]\n'
    path = tmp_path / "small.toml"
    path.write_text(text)
    case = read_case(path)
    points, cells, _ = distorted_block(n=2, distortion=0.0)
    sets = {name: np.flatnonzero(points[:, 2] == z) for name, z in (("foot", 0), ("head", 1))}
    write_mesh(tmp_path / "mesh.h5", points, cells, sets, "small")
    velocity = initial_velocity(case, tmp_path / "mesh.h5")
    assert np.abs(velocity[:, 2] - 2 * np.cos(np.pi * points[:, 2])).max() < 1e-15
    assert (velocity[:, 0] == (points[:, 2] == 1)).all()
    mesh, _ = load_case_mesh(case, tmp_path / "mesh.h5")
    none, curve = (load.curve for load in mesh.tractions)
    assert none is None and [curve(t) for t in (0.0, 0.05, 0.2)] == [0.0, 1.0, 2.0]
    assert replace(case.motion, velocities=()) == Motion(0.12, 0.06, 5.0, 6)
    for wrong in ('[[support]]\nset = "foot"\ndamping = 2.0\n', "[[velocity]]\nspin = [0, 0, 1]\n"):
        path.write_text(SMALL.replace("TIME_STEP", "0").replace("BELOW", "1") + wrong)
        with pytest.raises(InputError, match="support|velocity"):
            read_case(path)
