"""Problems with a known answer: affine fields and uniaxial stress, on distorted meshes."""

import numpy as np
import pytest
import ufl
from dolfinx import fem
from scipy.optimize import brentq

from blocks import (
    ELEMENTS,
    MATERIAL,
    MATERIALS,
    affine,
    affine_patch,
    distorted_block,
    pressed_block,
)
from hexahedra import Condition, HexMesh, refine
from newton import solve
from problem import MixedProblem
from symmetry import halve

GRADIENT = [[0.2, 0.1, -0.1], [0.05, -0.1, 0.15], [-0.1, 0.1, 0.05]]
TOLERANCE = 1e-10
# The last correction is at most TOLERANCE, and with quadratic convergence the remaining error is
# much smaller: only round-off, 2.2e-16 times a condition number of a few thousand.
EXACT = 1e-11


@ELEMENTS
@pytest.mark.parametrize("splits", [0, 1])
def test_affine_patch(make, splits):
    mesh = affine_patch(GRADIENT)
    n_nodes = len(mesh.points)
    points = mesh.points
    for _ in range(splits):
        mesh = refine(mesh)
    problem = make(mesh, MATERIALS)
    outcome = solve(problem, 2, TOLERANCE)
    # A homogeneous deformation is in equilibrium, and both elements contain it.
    difference = problem.nodal_displacement()[:n_nodes] - affine(points, GRADIENT)
    assert np.abs(difference).max() < EXACT
    assert outcome.residual < EXACT


@ELEMENTS
def test_uniaxial_stress_with_sliding_faces(make):
    stretch = 1.5
    points, cells, _ = distorted_block()
    values = np.tile([0.0, 0.0, stretch - 1], (len(points), 1))
    held = np.zeros_like(values)
    # Three symmetry planes, each held in its normal only, and the lid.
    conditions = [Condition(points[:, axis] == 0, (axis,), held) for axis in range(3)]
    conditions.append(Condition(points[:, 2] == 1, (2,), values))
    problem = make(HexMesh(points, cells, tuple(conditions)), MATERIALS)
    solve(problem, 2, TOLERANCE)
    lateral = _lateral_stretch(stretch)
    exact = affine(points, np.diag([lateral - 1, lateral - 1, stretch - 1]))
    assert np.abs(problem.nodal_displacement()[: len(points)] - exact).max() < EXACT


def _lateral_stretch(stretch):
    """Lateral stretch a of uniaxial stress: sigma_xx = 0 of the law.

    J sigma_xx = mu J^(-2/3) (a^2 - I1/3) + K (J - 1) J, with J = a^2 stretch and
    I1 = 2 a^2 + stretch^2: increasing in a, negative at a = 0.5, positive at a = 1.
    """
    E, nu = MATERIAL["young_modulus"], MATERIAL["poisson_ratio"]
    mu, K = E / 2 / (1 + nu), E / 3 / (1 - 2 * nu)

    def stress(a):
        J = a**2 * stretch
        return mu * J ** (-2 / 3) * (a**2 - stretch**2) / 3 + K * (J - 1) * J

    return brentq(stress, 0.5, 1.0, xtol=1e-15)


def test_eliminating_the_pressure_changes_nothing():
    # The condensed solution must satisfy each of the two rows of the mixed system.
    mesh = affine_patch(GRADIENT, bulge=0.2)
    problem = MixedProblem(mesh, MATERIALS)
    solve(problem, 2, TOLERANCE)
    forces, dilatation = problem.mixed_residual()
    # Forces against the reactions, volumes (m^3) against the volume of the block, 1 m^3.
    assert np.abs(forces[problem.free]).max() < EXACT * np.abs(forces[problem.fixed]).max()
    assert np.abs(dilatation).max() < EXACT


def test_load_steps_do_not_matter():
    # Compressed so far that in one load step the first corrections would invert elements.
    mesh = pressed_block((0.0, 0.0, -0.5))
    answers = []
    for load_steps in (1, 7):
        problem = MixedProblem(mesh, MATERIALS)
        outcome = solve(problem, load_steps, TOLERANCE)
        assert outcome.load_steps == load_steps  # shortened corrections, no halved step
        answers.append(problem.nodal_displacement())
    assert np.abs(answers[0] - answers[1]).max() < EXACT


def test_refined_solution_started_from_the_coarse_one():
    mesh = halve(pressed_block((0.0, 0.0, -0.2)))[0]
    coarse = MixedProblem(mesh, MATERIALS)
    solve(coarse, 2, TOLERANCE)
    started = MixedProblem(refine(mesh), MATERIALS)
    started.start_from(coarse)
    # The fine space contains the coarse solution. dolfinx finds the points by Newton's method.
    n_nodes = len(mesh.points)
    there = started.nodal_displacement()[:n_nodes] - coarse.nodal_displacement()
    assert np.abs(there).max() < 1e-8
    assert abs(_square_of_pressure(started) / _square_of_pressure(coarse) - 1) < 1e-8
    solve(started, 2, TOLERANCE, guessed=True)
    from_rest = MixedProblem(refine(mesh), MATERIALS)
    solve(from_rest, 2, TOLERANCE)
    difference = started.nodal_displacement() - from_rest.nodal_displacement()
    assert np.abs(difference).max() < EXACT


def _square_of_pressure(problem):
    """Integral of p^2 over the body, Pa^2 m^3."""
    return fem.assemble_scalar(fem.form(problem.pressure**2 * ufl.dx))
