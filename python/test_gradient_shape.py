"""Derivatives by the positions of nodes against differences of static answers."""

import numpy as np
import pytest
from test_gradient import BOX, METHODS, SETS, difference, sample

import sandglass as sg


@pytest.mark.parametrize("method", METHODS)
def test_positions_of_nodes(method):
    """Of nodes inside, on the surface and where the body is held, with distorted elements."""
    if method in ("tl-none", "ul-viscous") or method.startswith("ul-"):
        return  # no derivatives at all
    law = sg.NeoHookean(**sample("NeoHookean", np.random.default_rng(3)))
    grid = sg.Body(BOX, law, sets=SETS).mesh
    rng = np.random.default_rng(4)
    points = grid.points + 0.004 * rng.standard_normal(grid.points.shape)
    sets = {
        name: np.flatnonzero(np.isclose(grid.points[:, 2], z))
        for name, z in [("base", 0), ("head", 0.2)]
    }

    def made(X):
        loads = [
            sg.Displacement(set="base", value=(0, 0, 0)),
            sg.Force(set="head", total=(0.3, 0.2, 0.5), on="nodes"),
            sg.Relaxation(tolerance=1e-12),
        ]
        return sg.Body(sg.Mesh(X, grid.cells, sets), law, loads)

    solution = made(points).solve(name=method)
    of_u, of_R = rng.standard_normal(points.shape), rng.standard_normal(3)

    def J(X):
        answer = made(X).solve(name=method)
        return (of_u * answer.displacement).sum() + of_R @ answer.reactions["base"]

    if method == "t4-anp":
        with pytest.raises(sg.InputError, match="'t4-anp' has none by positions"):
            solution.gradient(of_u, points=True)
        return
    assert solution.gradient(of_u).points is None
    found = solution.gradient(of_u, {"base": of_R}, points=True).points
    for _ in range(3):
        along = rng.standard_normal(points.shape)
        own = difference(lambda x: J(points + x * along), 1e-5)
        assert (found * along).sum() == pytest.approx(own, rel=1e-6)


TURN = {"set": "head", "axis": "z", "angle": 25, "displacement": (0, 0, 0.01)}


@pytest.mark.parametrize("method", ["tl-perturbation", "tl-mean-dilatation"])
@pytest.mark.parametrize(
    "loads",
    [
        [sg.Gravity(value=(1, -1, 5))],
        [sg.Gravity(value=(0, -1, 5)), sg.Mass(set="side", total=0.05)],
        [sg.Force(set="side", total=(0.3, 0.2, 0.5), moment=(0.01, 0, 0.02))],
        [sg.Force(set="side", total=(0.3, 0.2, 0.5), times=[0, 1], factors=[0, 0.5])],
        [sg.Force(set="side", total=(0.2, 0, 0)), sg.Support(set="head", stiffness=1e5)],
        [sg.Force(set="side", total=(0.2, 0, 0))]
        + [sg.Support(set="head", stiffness=1e5, only_normal=True)],
        [sg.Rotation(**TURN)],
        [sg.Rotation(**TURN, center=(0.03, 0.02, 0)), sg.Gravity(value=(0, -2, 0))],
    ],
    ids=lambda loads: " ".join(f"{type(each).__name__}{len(each._values)}" for each in loads),
)
def test_loads_change_with_the_positions_of_nodes(loads, method):
    """Volumes, areas, normals, centroids and arms; of displacements and of reactions. Weight pulls
    upwards: bodies that topple have other answers nearby, which differences would find."""
    law = sg.NeoHookean(young_modulus=6e3, poisson_ratio=0.4, density=1000)
    grid = sg.Body(BOX, law, sets=SETS).mesh
    rng = np.random.default_rng(8)
    points = grid.points + 0.004 * rng.standard_normal(grid.points.shape)
    places = {"base": (2, 0), "head": (2, 0.2), "side": (0, 0.1)}
    sets = {n: np.flatnonzero(np.isclose(grid.points[:, i], x)) for n, (i, x) in places.items()}
    fixed = [sg.Displacement(set="base", value=(0, 0, 0)), sg.Relaxation(tolerance=1e-12)]

    def made(X):
        return sg.Body(sg.Mesh(X, grid.cells, sets), law, [*fixed, *loads])

    solution = made(points).solve(name=method)
    of_u, of_R = rng.standard_normal(points.shape), rng.standard_normal(3) * 1e-2

    def J(X):
        answer = made(X).solve(name=method)
        return (of_u * answer.displacement).sum() + of_R @ answer.reactions["base"]

    found = solution.gradient(of_u, {"base": of_R}, points=True).points
    for _ in range(3):
        along = rng.standard_normal(points.shape)
        own = difference(lambda x: J(points + x * along), 1e-5)
        assert (found * along).sum() == pytest.approx(own, rel=1e-6)
