"""Random misuse of the package never crashes: it raises exceptions that name what is wrong."""

import copy
import random

import numpy as np
import pytest

import sandglass as sg

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


def arguments():
    """Right arguments, of which one is replaced."""
    return {
        "mesh": {
            "points": POINTS,
            "cells": CELLS,
            "sets": {"base": [0, 1, 2, 3], "head": [8, 9, 10, 11]},
            "element_sets": {"low": [0]},
        },
        "law": {"young_modulus": 3e3, "poisson_ratio": 0.4, "density": 1e3},
        "base": {"set": "base", "value": [0, 0, 0], "components": "xyz"},
        "head": {"set": "head", "value": [0, 0, 0.01]},
        "force": {"set": "head", "total": [0, 0, 0.01], "moment": None, "on": "faces"},
        "body": {"sets": {"mine": {"x": [0, 0]}}, "element_sets": None, "name": "body"},
        "solve": {"threads": 1, "progress": None, "name": "tl-perturbation", "kappa": 0.1},
        "gradient": {"displacement": POINTS, "reactions": {"head": [1, 0, 0]}},
        "sensitivity": {"materials": [{"young_modulus": 1}], "forces": POINTS, "imposed": POINTS},
    }


def use(given):
    mesh = sg.Mesh(**given["mesh"])
    tables = [sg.Displacement(**given["base"]), sg.Displacement(**given["head"])]
    body = sg.Body(mesh, sg.NeoHookean(**given["law"]), tables, **given["body"])
    body.tables.append(sg.Force(**given["force"]))
    solution = body.solve(**given["solve"])
    assert np.isfinite(solution.gradient(**given["gradient"]).forces).all()
    assert np.isfinite(solution.sensitivity(**given["sensitivity"])).all()
    return solution


def misuse(generator):
    """Arguments with one mistake, and its place as words that the message should have."""
    given = copy.deepcopy(arguments())
    part = generator.choice(list(given))
    key = generator.choice(list(given[part]))
    kind = generator.randrange(6)
    if kind == 0:
        other = key + generator.choice(["s", "_", "\u00e9"])
        given[part][other] = given[part].pop(key)
        return given, other
    if kind == 1 and part in ("mesh", "body", "gradient") and isinstance(given[part][key], dict):
        name = generator.choice(list(given[part][key]))
        given[part][key][name] = generator.choice(NONSENSE)
        return given, name
    given[part][key] = generator.choice(NONSENSE)
    return given, key


def test_the_right_arguments_are_right():
    assert use(arguments()).displacement[:, 2].max() == 0.01


@pytest.mark.parametrize("seed", range(200))
def test_misuse_is_an_exception_that_names_its_place(seed):
    """Or what is given makes sense by chance, such as a finite number; then there is an answer."""
    given, place = misuse(random.Random(seed))
    try:
        assert np.isfinite(use(given).displacement).all()
    except (TypeError, sg.InputError) as error:
        assert place.rstrip("_s\u00e9") in str(error), str(error)
    except sg.ComputationError as error:  # loads or moduli without equilibrium
        assert str(error)


@pytest.mark.parametrize("name", ["Body", "Mesh", "Solution", "Simulation"])
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
