"""Random misuse of the package never crashes: it raises exceptions that name what is wrong."""

import copy
import importlib.util
import os
import random

import numpy as np
import pytest

import sandglass as sg

os.environ.setdefault("MPLBACKEND", "Agg")

# The first of 500 seeds; others are tried by hand.
FIRST = int(os.environ.get("SANDGLASS_MISUSE", 0))
POINTS = np.array([(x, y, z) for z in (0, 0.1, 0.2) for y in (0, 0.1) for x in (0, 0.1)], float)
CELLS = np.array([[0, 1, 3, 2, 4, 5, 7, 6], [4, 5, 7, 6, 8, 9, 11, 10]])
NONSENSE = [
    None,
    True,
    -1,
    2**70,
    np.nan,
    np.inf,
    -1e308,
    "nonsense",
    "\x00\x7f\ud800",
    b"bytes",
    [],
    [[], [1]],
    {},
    {1: 2},
    {"x": [1, 0]},
    object(),
    len,
    np.zeros(0),
    np.zeros((2, 3, 4)),
    np.full(3, np.nan),
    np.array(["a"]),
    np.array([None]),
    np.arange(3) * 1j,
    np.datetime64("2020-01-01"),
    POINTS[:, :2],
    CELLS + 0.5,
    CELLS * 100,
    -CELLS,
    CELLS.astype("uint64") + np.uint64(2**63),
]


LAW = {"young_modulus": 3e3, "poisson_ratio": 0.4, "density": 1e3}
BASE = {"set": "base", "value": [0, 0, 0], "components": "xyz"}
HEAD = {"set": "head", "value": [0, 0, 0.01]}
FORCE = {"set": "head", "total": [0, 0, 0.01], "moment": None, "on": "faces"}
MESH = {
    "points": POINTS,
    "cells": CELLS,
    "sets": {"base": [0, 1, 2, 3], "head": [8, 9, 10, 11]},
    "element_sets": {"low": [0]},
}


def body(law=sg.NeoHookean(**LAW), mesh=None, **more):
    loads = [sg.Displacement(**BASE), sg.Displacement(**HEAD)]
    return sg.Body(mesh or sg.Mesh(**MESH), law, loads, **more)


def loaded(table, **values):
    made = body()
    made.tables.append(table(**values))
    return made.solve()


def moved(use):
    """A call of a method of a simulation."""

    def call(**values):
        simulation = body().simulation()
        found = getattr(simulation, use)(**values)
        assert np.isfinite(simulation.displacements).all()
        return found

    return call


def of(use, make):
    return lambda **values: getattr(make(), use)(**values)


def batch():
    return body().batch(3)


ONES = np.ones((3, 2, 3)) * 1e-3
# Every public callable with right arguments, of which one will be replaced.
CALLS = {
    "Mesh": (lambda **v: body(mesh=sg.Mesh(**v)).solve(), MESH),
    "Mesh.read": (sg.Mesh.read, {"file": "mesh.h5", "spacing": None}),
    "Mesh.of": (sg.Mesh.of, {"mesh": "mesh.h5"}),
    "Mesh.save": (of("save", lambda: body().mesh), {"file": "own.h5"}),
    "NeoHookean": (lambda **v: body(sg.NeoHookean(**v)).solve(), LAW),
    "moduli": (
        lambda **v: body(sg.NeoHookean(**v)).solve().gradient(POINTS),
        LAW | {"young_modulus": [3e3, 4e3], "poisson_ratio": [0.4, 0.3]},
    ),
    "Displacement": (lambda **v: loaded(sg.Displacement, **v), HEAD),
    "Force": (lambda **v: loaded(sg.Force, **v), FORCE),
    "Body": (
        lambda **v: body(**v).solve(),
        {"sets": {"mine": {"x": [0, 0]}}, "element_sets": None, "name": "body"},
    ),
    "Body.read": (sg.Body.read, {"file": "case.toml"}),
    "Body.save": (of("save", body), {"file": "own.toml"}),
    "Body.solve": (
        of("solve", body),
        {"threads": 1, "progress": None, "name": "tl-perturbation", "kappa": 0.1, "sleep": None},
    ),
    "refined": (of("solve", body), {"against": "truth", "accuracy": 0.5, "name": "tl-adaptive"}),
    "Body.simulation": (
        of("simulation", body),
        {"precision": "double", "kappa": 0.1, "damping": 1.0, "step_fraction": 0.5, "threads": 1},
    ),
    "Body.batch": (
        of("batch", body),
        {"bodies": 3, "precision": "double", "kappa": 0.1, "damping": 1.0, "threads": 1},
    ),
    "Batch.run": (
        of("run", batch),
        {"seconds": 0.01, "frames": 2, "stiffness": [1, 2, 3], "driven": {"head": ONES}}
        | {"materials": [{"poisson_ratio": [0.1, 0.2, 0.3]}]},
    ),
    "Batch.set_parameters": (
        of("set_parameters", batch),
        {"materials": {"young_modulus": [1e3, 2e3, 3e3], "poisson_ratio": 0.3}},
    ),
    "Batch.move": (of("move", batch), {"set": "head", "displacements": ONES[:, 0]}),
    "Batch.impose": (of("impose", batch), {"factors": [0.1, 0.2, 0.3]}),
    "Batch.scale_stiffness": (of("scale_stiffness", batch), {"factors": [0.1, 0.2, 0.3]}),
    "Batch.advance": (of("advance", batch), {"seconds": 0.01}),
    "Batch.reaction": (of("reaction", batch), {"set": "head"}),
    "Batch.nodes": (of("nodes", batch), {"set": "head"}),
    "Simulation": (sg.Simulation, {"case": "case.toml", "precision": "float", "kappa": 0.1}),
    "move": (moved("move"), {"set": "head", "displacement": [0, 0, 1e-3]}),
    "impose": (moved("impose"), {"factor": 0.5}),
    "advance": (moved("advance"), {"seconds": 0.01}),
    "save_checkpoint": (moved("save_checkpoint"), {"file": "own.checkpoint"}),
    "resume": (moved("resume"), {"file": "kept.checkpoint"}),
    "reaction": (moved("reaction"), {"set": "head"}),
    "nodes": (moved("nodes"), {"set": "head"}),
    "gradient": (
        of("gradient", lambda: body().solve()),
        {"displacement": POINTS, "reactions": {"head": [1, 0, 0]}, "points": True},
    ),
    "sensitivity": (
        of("sensitivity", lambda: body().solve()),
        {"materials": [{"young_modulus": 1}], "forces": POINTS, "imposed": POINTS},
    ),
    "Solution.estimate": (of("estimate", lambda: body().solve()), {"against": "golden"}),
    "Solution.frame": (of("frame", lambda: body().solve()), {"number": -1}),
    "Solution.plot": (
        of("plot", lambda: body().solve()),
        {"field": "stress", "frame": -1, "scale": 1.0},
    ),
    "Solution.to_vtk": (of("to_vtk", lambda: body().solve()), {"frame": 0}),
    "Solution.save": (of("save", lambda: body().solve()), {"file": "own.npz"}),
    "estimate": (sg.estimate, {"answer": body(), "against": "golden"}),
    "choose": (
        sg.choose,
        {"case": "case.toml", "tolerance": "90%", "budget": "9s", "methods": ["tl-full"]}
        | {"threads": 1, "realtime": False, "all": False, "against": None, "progress": None},
    ),
    "verify": (
        lambda case, **v: sg.verify(case, **v),
        {"case": "case.toml", "precision": "double", "costs": False, "threads": 1}
        | {"results": None, "progress": None},
    ),
    "score": (
        sg.score,
        {"displacement": POINTS, "case": "case.toml", "name": "mine", "field": ""}
        | {"tolerance": 1e-5},
    ),
    "kernels": (
        sg.kernels,
        {"method": "tl-full", "case": "case.toml", "dialect": "c", "precision": "double"}
        | {"material": 1, "step": False},
    ),
    "write_mesh": (
        sg.write_mesh,
        {"case": "case.toml", "output": "own.h5", "format": "h5", "deck": "", "hourglass": None},
    ),
    "stability": (
        sg.stability,
        {"case": "case.toml", "maps": ["kappa"], "values": ["kappa=0.1"], "methods": ["tl-none"]}
        | {"folder": None, "threads": 1},
    ),
    "bench": (
        lambda case, **v: sg.bench(case, **v),
        {"case": "case.toml", "rest": True, "methods": ["tl-full"], "precision": ["float"]}
        | {"threads": [1]},
    ),
}

NEEDS = {"Solution.plot": "matplotlib", "Solution.to_vtk": "vtkmodules"}
for _name, _module in NEEDS.items():
    if importlib.util.find_spec(_module) is None:
        del CALLS[_name]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    body(mesh=sg.Mesh(**MESH)).save("case.toml")
    os.rename("case.h5", "mesh.h5")
    body().simulation().save_checkpoint("kept.checkpoint")
    text = open("case.toml").read().replace("case.h5", "mesh.h5")
    open("case.toml", "w").write(text)


def misuse(generator):
    """A function, right arguments, the same with one mistake, and its place as a word."""
    name = generator.choice(list(CALLS))
    function, right = CALLS[name]
    given = copy.deepcopy(right)
    key = generator.choice(list(given))
    kind = generator.randrange(6)
    if kind == 0:
        other = key + generator.choice(["s", "_", "\u00e9"])
        given[other] = given.pop(key)
        return function, right, given, other
    if kind == 1 and isinstance(given[key], dict):
        name = generator.choice(list(given[key]))
        given[key][name] = generator.choice(NONSENSE)
        return function, right, given, name
    given[key] = generator.choice(NONSENSE)
    return function, right, given, key


@pytest.mark.parametrize("name", CALLS)
def test_the_right_arguments_are_right(name, folder):
    function, right = CALLS[name]
    function(**right)


@pytest.mark.parametrize("seed", range(FIRST, FIRST + 500))
def test_misuse_is_an_exception_that_names_its_place(seed, folder):
    """Or what is given makes sense by chance, such as a finite number; then there is an answer."""
    function, right, given, place = misuse(random.Random(seed))
    try:
        found = function(**given)
        if isinstance(found, sg.Solution):
            assert np.isfinite(found.displacement).all()
    except (TypeError, IndexError, sg.InputError) as error:
        called = place == "progress" and "len()" in str(error)  # the callback's own error
        assert called or place.rstrip("_s\u00e9") in str(error), str(error)
        if place in right:  # a known name: the words are ours, not those of the binding
            assert "incompatible function arguments" not in str(error)
    except sg.ComputationError as error:  # loads or moduli without equilibrium
        assert str(error)


def test_every_public_callable_is_misused():
    """Those without arguments, and of classes made from declarations a law and two loads."""
    without = {"cases", "methods", "axes", "flops"}
    functions = {name for name in sg.commands.__all__ if name not in ("Record", *without)}
    assert functions <= set(CALLS)


@pytest.mark.parametrize("name", ["Body", "Mesh", "Solution", "Simulation", "Batch"])
def test_dead_objects_raise(name):
    """Objects that were never made, as after __new__ alone."""
    cls = getattr(sg, name)
    try:
        dead = cls.__new__(cls)
    except TypeError:
        return
    for member in dir(cls):
        if member.startswith("__"):
            continue
        with pytest.raises((TypeError, AttributeError)):
            value = getattr(dead, member)
            if not callable(value) or member in ("read", "of_toml", "of_mesh", "of"):
                raise TypeError  # of the class
            value()
