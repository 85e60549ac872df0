"""The Python module: the same motion as the program's, live views, errors as exceptions."""

import gc
import os
import subprocess
import sys
import threading
import weakref

import h5py
import numpy as np
import pytest
from command_line import BARE, ROOT, dynamic, sandglass as program
from module_folder import FOLDER

import sandglass

DYNAMIC = dynamic(BARE, duration=0.2, time_step=1e-3, damping=3.0, frames=1)
END = np.array([0.02, 0.0, 0.01])  # where BLOCK's head goes


def smooth(t):
    return t**3 * (10 - 15 * t + 6 * t**2)


@pytest.fixture
def case(tmp_path):
    file = tmp_path / "block.toml"
    file.write_text(DYNAMIC)
    return file


@pytest.fixture
def body(case):
    return sandglass.Simulation(case)


@pytest.mark.parametrize(
    "precision, limit", [("double", 200 * 200 * 1.8e-18), ("float", 200 * 1e-9)]
)
def test_moved_by_hand_it_matches_the_program(case, tmp_path, precision, limit):
    """Limits: half a unit in the last place of 0.02 m at driven nodes in each of 200 steps,
    accumulated by two sums over as many; in float the signs of roundings vary, and one suffices."""
    result = tmp_path / "result.h5"
    done = program("run", case, "--precision", precision, "-o", result)
    assert done.returncode == 0, done.stderr
    with h5py.File(result) as file:
        expected = file["frames/0001/displacement"][:]
        points = file["mesh/points"][:]
    body = sandglass.Simulation(case, precision=precision)
    for step in range(1, 201):
        body.move("head", END * smooth(step / 200))
        body.advance(1e-3)
    assert np.array_equal(body.points, points)
    assert body.time == pytest.approx(0.2, rel=1e-13)
    assert np.abs(body.displacements[body.rows] - expected).max() < limit
    assert np.abs(expected).max() > 0.019


def test_displacements_are_a_view_of_the_present(body):
    u = body.displacements
    address = u.__array_interface__["data"][0]
    assert u.shape == (45, 3) and u.strides == (32, 8) and u.dtype == np.float64
    body.move("head", END)
    body.advance(0.05)
    head = body.rows[body.nodes("head")]
    assert np.array_equal(u[head], np.tile(END, (9, 1)))
    assert body.displacements.__array_interface__["data"][0] == address


def test_views_keep_their_simulation_alive_and_nothing_else_does(case):
    body = sandglass.Simulation(case)
    body.move("head", END)
    body.advance(0.05)
    alive = weakref.ref(body)
    u, rows = body.displacements, body.rows
    before = u.copy()
    assert u.base is body
    del body
    gc.collect()
    others = [sandglass.Simulation(case) for _ in range(20)]  # would take freed memory
    assert np.array_equal(u, before) and sorted(rows) == list(range(45))
    assert alive() is not None
    del u, rows
    assert alive() is None and len(others) == 20


@pytest.mark.parametrize("name", ["displacements", "rows", "points", "cells"])
def test_views_are_read_only(body, name):
    view = getattr(body, name)
    with pytest.raises(ValueError, match="read-only"):
        view[0] = 1
    with pytest.raises(ValueError):
        view.setflags(write=True)
    with pytest.raises(ValueError, match="read-only"):
        body.nodes("head")[0] = 1
    with pytest.raises(AttributeError):
        setattr(body, name, view)


def test_a_mesh_of_arrays_is_the_same_body(body):
    text = DYNAMIC.replace(DYNAMIC[DYNAMIC.index("[mesh]") : DYNAMIC.index("[material]")], "")
    text = text.replace("head = { z = [0.2, 0.2] }\n", "")
    sets = {"head": body.nodes("head")[::-1].copy()}  # any order
    same = sandglass.Simulation.of_mesh(body.points, body.cells, sets, text)
    for each in (body, same):
        each.move("head", END)
        each.advance(0.1)
    assert np.array_equal(same.displacements, body.displacements)
    assert np.array_equal(same.cells, body.cells)
    with pytest.raises(TypeError):
        sandglass.Simulation.of_mesh(body.points, body.cells + 0.5, sets, text)
    with pytest.raises(ValueError, match=r"cells must have the shape \(m, 8\)"):
        sandglass.Simulation.of_mesh(body.points, body.cells[:, :4], sets, text)
    with pytest.raises(ValueError, match="-1 is not a node number"):
        sandglass.Simulation.of_mesh(body.points, body.cells, {"head": np.array([-1])}, text)
    with pytest.raises(ValueError, match="names node 45"):
        sandglass.Simulation.of_mesh(body.points, body.cells, {"head": np.array([45])}, text)


def test_each_node_may_go_its_own_way(body):
    own = END * np.linspace(0.5, 1.0, 9)[:, None]
    body.move("head", own)
    body.advance(0.05)
    assert np.array_equal(body.displacements[body.rows[body.nodes("head")]], own)
    body.move("head", [0, 0, 0])  # a list of integers will do
    body.advance(0.05)
    assert not body.displacements[body.rows[body.nodes("head")]].any()


def test_it_settles_where_nothing_moves(body):
    """Left over are forces of 1e-8 of the reactions, the tolerance of the search."""
    body.move("head", END)
    assert body.settle() > 3 and body.time == 0.0
    still = body.displacements.copy()
    body.advance(0.05)
    assert np.abs(body.displacements - still).max() < 1e-7 * np.abs(END).max()


def test_a_copy_is_a_snapshot(body):
    body.move("head", END)
    body.advance(0.05)
    snapshot = body.copy()
    body.advance(0.05)
    assert snapshot.time < body.time
    snapshot.advance(0.05)
    assert np.array_equal(snapshot.displacements, body.displacements)
    assert snapshot.displacements.base is snapshot


@pytest.mark.parametrize("method", ["tl-perturbation", "tl-adaptive", "ul-perturbation"])
@pytest.mark.parametrize("precision", ["double", "float"])
def test_a_saved_simulation_is_resumed_with_the_same_bits(case, tmp_path, precision, method):
    """In the middle of a path, between two checks of the elements, by a new simulation."""
    file = tmp_path / "state.checkpoint"
    body = sandglass.Simulation(case, precision=precision, method=method)
    body.move("head", END)
    body.advance(0.05)
    body.advance(3.3 * body.step_size)
    body.move("head", 0.2 * END)
    body.impose(0.4)
    body.save_checkpoint(file)
    kept = body.displacements.copy()
    other = sandglass.Simulation(case, precision=precision, method=method)
    view = other.displacements
    other.resume(str(file))
    assert other.time == body.time and other.step_size == body.step_size
    assert np.array_equal(view, kept)  # which shows the resumed state
    for each in (body, other):
        each.advance(0.1)
    assert np.array_equal(view, body.displacements) and not np.array_equal(view, kept)
    assert np.array_equal(other.reaction("head"), body.reaction("head"))


def test_a_checkpoint_of_another_simulation_is_refused(case, body, tmp_path):
    file = tmp_path / "state.checkpoint"
    body.save_checkpoint(file)
    for words, settings in [
        ("precision: 'double' in the checkpoint, 'float'", {"precision": "float"}),
        ("method: 'tl-perturbation' in the checkpoint", {"method": "tl-full"}),
        ("damping: ", {"damping": 7.5}),
        ("steps: '0.9 of the stable one", {"step_fraction": 0.5}),
    ]:
        other = sandglass.Simulation(case, **settings)
        with pytest.raises(sandglass.InputError, match=words):
            other.resume(file)
        assert other.time == 0
    (tmp_path / "damaged").write_bytes(file.read_bytes()[:-1] + b"?")
    for wrong in ("damaged", "nowhere"):
        with pytest.raises(sandglass.InputError, match=wrong):
            body.resume(tmp_path / wrong)
    with pytest.raises(TypeError, match="file must be a path, but is a float"):
        body.save_checkpoint(1.5)


def test_wrong_arguments_are_named(case, body):
    for use, words in [
        (lambda: sandglass.Simulation(3), "case must be a path, but is a int"),
        (
            lambda: sandglass.Simulation(case, threads=1.5),
            "threads must be an integer, but is a fl",
        ),
        (lambda: sandglass.Simulation(case, kappa="much"), "kappa must be a number, but is a str"),
        (
            lambda: sandglass.Simulation(case, step=1),
            "step is not a setting of a simulation; allowed: p",
        ),
        (lambda: body.advance("long"), "seconds must be a number, but is a str"),
        (lambda: body.impose(None), "factor must be a number, but is a NoneType"),
        (lambda: body.move(3, END), "set must be a text, but is a int"),
        (lambda: body.move("head", "far"), "displacement must be an array of numbers"),
        (lambda: body.reaction(None), "set must be a text, but is a NoneType"),
        (lambda: body.nodes(2), "set must be a text, but is a int"),
    ]:
        with pytest.raises(TypeError, match=words):
            use()


def test_impose_follows_the_case(case):
    body = sandglass.Simulation(case, damping=20.0)
    other = body.copy()
    body.move("head", 0.5 * END)
    other.impose(0.5)
    for each in (body, other):
        each.advance(2.0)
    assert np.array_equal(other.displacements, body.displacements)
    assert other.reaction("head")[2] > 0.1  # it is pulled, and at rest
    assert np.allclose(other.reaction("head"), body.reaction("head"), rtol=1e-12)


def test_errors_are_exceptions_with_the_solvers_words(case, body):
    assert issubclass(sandglass.InputError, ValueError)
    assert issubclass(sandglass.ComputationError, RuntimeError)
    with pytest.raises(sandglass.InputError, match="did you mean 'head'"):
        body.move("haed", END)
    with pytest.raises(sandglass.InputError, match="seconds = -1"):
        body.advance(-1)
    with pytest.raises(
        sandglass.InputError, match=r"seconds = 1e\+30 must be less than 2\^53 steps"
    ):
        body.advance(1e30)
    with pytest.raises(sandglass.InputError, match="no such case file"):
        sandglass.Simulation("nowhere.toml")
    with pytest.raises(sandglass.InputError, match="'half' must be 'double' or 'float'"):
        sandglass.Simulation(case, precision="half")
    with pytest.raises(sandglass.InputError, match="has no such parameter"):
        sandglass.Simulation(case, method="tl-full", kappa=0.1)
    with pytest.raises(sandglass.InputError, match="displacement must have the shape"):
        body.move("head", [1.0, 2.0])
    with pytest.raises(TypeError):
        body.move("head", "far")
    body.move("head", [0, 0, -5.0])
    with pytest.raises(sandglass.ComputationError, match="det F must be positive"):
        body.advance(0.1)


@pytest.mark.parametrize("far", [1e3, 1e60, 1e300])
def test_no_advance_ends_with_nan(body, far):
    """However few steps it takes: displacements overflow long before the 20th, the first check."""
    body.move("head", [far, 0, 0])
    with pytest.raises(sandglass.ComputationError, match="no longer finite"):
        for _ in range(10):
            body.advance(body.step_size)
            assert np.isfinite(body.displacements).all()
    assert body.time == 0 and not np.array(body.displacements).any()


def test_other_threads_run_while_it_steps_and_cannot_step_it_too(body):
    """The other thread counts while the main one is in `advance`, so the GIL is released."""
    counted, refused, done = [], [], threading.Event()

    def look():
        while not done.is_set():
            counted.append(1)
            try:
                body.time
            except RuntimeError as error:
                refused.append(str(error))
                return

    thread = threading.Thread(target=look)
    body.advance(1e-3)
    thread.start()
    try:
        for _ in range(500):  # each takes thousands of steps; on a busy machine the thread may wait
            body.advance(50.0)
            if refused:
                break
    finally:
        done.set()
        thread.join()
    assert refused == ["the simulation is busy in another thread"]
    body.advance(1e-3)  # and it is free again


def test_everything_is_documented():
    assert sandglass.__doc__
    for name in dir(sandglass.Simulation):
        if not name.startswith("_"):
            assert getattr(sandglass.Simulation, name).__doc__, name


def test_example_runs(case):
    done = subprocess.run(
        [sys.executable, ROOT / "python" / "example.py", case, "head", "0.02", "0", "0.01"],
        env=os.environ | {"PYTHONPATH": FOLDER},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert len(lines) == 6
    assert lines[-1].startswith("1.00 s: largest displacement 0.02")


def test_a_device_takes_its_steps(case):
    """They are those of this processor; device_simulation_test.cpp derives a limit."""
    here = sandglass.Simulation(case)
    try:
        there = sandglass.Simulation(case, device="opencl")
    except sandglass.InputError as error:
        pytest.skip(str(error))
    view = there.displacements
    for body in here, there:
        body.impose(0.5)
        body.advance(0.1)
    assert np.abs(view).max() > 0.005
    assert np.abs(view - here.displacements).max() < 1e-11 * np.abs(view).max()
    copied = there.copy()
    for body in there, copied:
        body.settle()
        body.advance(0.05)
    assert np.array_equal(view, copied.displacements)
    with pytest.raises(sandglass.InputError, match="device = 'cuda' is no processor of this mach"):
        sandglass.Simulation(case, device="cuda")
