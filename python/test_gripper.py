"""Two jaws lift a soft block by friction, or let it slip."""

import numpy as np
import pytest
from lattice import lattice

import sandglass as sg

EDGE, DENSITY, GRAVITY = 0.04, 1000.0, 9.81  # m, kg/m^3, m/s^2
WEIGHT = EDGE**3 * DENSITY * GRAVITY
FRICTION = 0.5


def gripped_block(method, n=6, left=None, right=None):
    """The block on a floor between jaws that just touch it, under its weight.

    left, right: further parameters of the jaws.
    """
    points, cells, node = lattice(*[np.linspace(0, EDGE, n + 1)] * 3)
    sets = {"west": node[:, :, 0].ravel(), "east": node[:, :, n].ravel(), "foot": node[0].ravel()}
    floor = {"shape": "plane", "point": (0, 0, 0), "method": method}
    jaw = {"shape": "plane", "friction": FRICTION, "method": method}
    loads = [
        sg.Obstacle(name="floor", set="foot", normal=(0, 0, 1), **floor),
        sg.Obstacle(
            name="left", set="west", point=(0, 0, 0), normal=(1, 0, 0), **jaw, **(left or {})
        ),
        sg.Obstacle(
            name="right", set="east", point=(EDGE, 0, 0), normal=(-1, 0, 0), **jaw, **(right or {})
        ),
        sg.Gravity(value=(0, 0, -GRAVITY), times=[0], factors=[1]),
        sg.Dynamics(duration=1.0, damping=20.0),
    ]
    law = sg.NeoHookean(young_modulus=3000.0, poisson_ratio=0.45, density=DENSITY)
    mesh = sg.Mesh(points, cells, sets)
    return sg.Body(mesh, law, loads).simulation(method="tl-perturbation")


def pinched_and_lifted(method, squeeze, lift=0.02):
    """The block after each jaw moved by `squeeze` (m) onto it and both rose by `lift` (m)."""
    block = gripped_block(method)
    block.advance(0.5)
    for height, seconds in (0.0, 0.5), (0.0, 0.5), (lift, 1.0), (lift, 1.0):
        block.move("left", (squeeze, 0, height))
        block.move("right", (-squeeze, 0, height))
        block.advance(seconds)
    return block


@pytest.mark.parametrize("method", ["kinematic", "penalty"])
def test_jaws_lift_what_friction_holds(method):
    """It hangs from the jaws with all of its weight, and does not creep in two seconds."""
    block = pinched_and_lifted(method, squeeze=0.004)
    left, right = (np.array(block.reaction(name)) for name in ("left", "right"))
    assert block.reaction("floor") == pytest.approx((0, 0, 0), abs=1e-9 * WEIGHT)
    assert left + right == pytest.approx([0, 0, WEIGHT], abs=1e-3 * WEIGHT)
    assert np.hypot(*left[1:]) < FRICTION * left[0]
    before = block.displacements.copy()
    assert before[:, 2].min() > 0
    block.advance(2.0)
    assert np.abs(block.displacements - before).max() < 1e-6 * EDGE


@pytest.mark.parametrize("method", ["kinematic", "penalty"])
def test_jaws_slip_on_what_is_too_heavy(method):
    """They carry what friction can, and the floor the rest."""
    block = pinched_and_lifted(method, squeeze=0.0005)
    left, right = (np.array(block.reaction(name)) for name in ("left", "right"))
    carried, floor = (left + right)[2], block.reaction("floor")[2]
    assert 0.2 * WEIGHT < carried <= FRICTION * (left[0] - right[0]) * (1 + 1e-9)
    assert carried + floor == pytest.approx(WEIGHT, rel=1e-3)


@pytest.mark.parametrize("method", ["kinematic", "penalty"])
def test_moves_of_a_case_are_those_of_a_program(method):
    """Jaws close and then rise by curves of the case as when a program moves them, step by step."""
    squeeze, lift = 0.004, 0.02
    rise = {"displacement": (0, 0, lift), "times": [1.5, 2.5], "factors": [0, 1]}
    close = {"times": [0.5, 1.0], "factors": [0, 1], "move": [rise]}
    left, right = ({"displacement": (x, 0, 0), **close} for x in (squeeze, -squeeze))
    block = gripped_block(method, left=left, right=right)
    for seconds in (0.5, 0.5, 0.5, 1.0, 1.0):
        block.advance(seconds)
    other = pinched_and_lifted(method, squeeze, lift)
    # Rounding of positions, which friction carries on.
    assert np.abs(block.displacements - other.displacements).max() < 1e-6 * EDGE
    for jaw in ("left", "right"):
        assert block.reaction(jaw) == pytest.approx(other.reaction(jaw), abs=1e-6 * WEIGHT)


def test_mistakes_in_moves_are_named():
    for move, rule in (
        ({"displacement": (0, 0, 1), "times": [0, 1], "factors": [1]}, "one factor for each time"),
        ({"displacement": (0, 0, 1), "times": [0], "formula": "t"}, "a formula or a table"),
        ({"displacement": (0, 1)}, "must be a list of 3"),
        ({"times": [0.0], "factors": [1.0]}, "displacement is missing"),
        ({"displacement": (0, 0, 1), "value": 1}, "value is not a key of this table"),
    ):
        with pytest.raises(sg.InputError, match=rule) as error:
            gripped_block("kinematic", left={"move": [move]})
        assert "obstacle.move" in str(error.value)
    for left, rule in (
        ({"times": [0.0], "factors": [1.0]}, "is needed with times"),
        ({"move": {"displacement": (0, 0, 1)}}, r"an array of tables, \[\[obstacle.move"),
    ):
        with pytest.raises(sg.InputError, match=rule):
            gripped_block("kinematic", left=left)
