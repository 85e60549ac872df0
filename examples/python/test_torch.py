"""The layer of PyTorch against PyTorch's own differences; where PyTorch is installed."""

import sys
from pathlib import Path

import numpy as np
import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "python")]

import module_folder  # noqa: E402

sys.path.insert(0, module_folder.FOLDER)
torch = pytest.importorskip("torch")

import sandglass as sg  # noqa: E402
from torch_layer import Equilibrium  # noqa: E402

SIZE, ELEMENTS = (0.04, 0.04, 0.08), (1, 1, 2)


def made(moduli, forces):
    """A body of two materials, with a force on each node of its head."""
    laws = [
        sg.NeoHookean(young_modulus=E, poisson_ratio=0.3, density=1000, elements=name)
        for E, name in zip(moduli, "ab")
    ]
    mesh = sg.Mesh.of(sg.Box(size=SIZE, elements=ELEMENTS))
    nodes = {f"n{n}": np.array([n]) for n in np.flatnonzero(forces.any(axis=1))}
    loads = [sg.Force(set=f"n{n[1:]}", total=forces[int(n[1:])], on="nodes") for n in nodes]
    tables = [sg.Displacement(set="foot", value=(0, 0, 0)), sg.Relaxation(tolerance=1e-12)]
    sets = nodes | {"foot": {"z": [0, 0]}}
    parts = {"a": {"z": [0, 0.04]}, "b": {"z": [0.04, 0.08]}}
    return sg.Body(mesh, laws, tables + loads, sets=sets, element_sets=parts)


def test_derivatives_by_moduli_and_forces():
    """Differences of answers with a residual of 1e-12 by steps of 1e-4 are exact to 1e-7; units are
    kPa and N, so that all derivatives are comparable, and lengths are in cm."""
    forces = torch.zeros((12, 3), dtype=torch.double)
    forces[-4:] = torch.tensor([0.02, 0.01, 0.3], dtype=torch.double)
    moduli = torch.tensor([3.0, 5.0], dtype=torch.double)

    def answer(moduli, head):
        full = torch.cat([torch.zeros((8, 3), dtype=torch.double), head])
        return 100 * Equilibrium.apply(made, 1000 * moduli, full)

    inputs = (moduli.requires_grad_(), forces[-4:].clone().requires_grad_())
    assert torch.autograd.gradcheck(answer, inputs, eps=1e-4, atol=1e-6, rtol=1e-5)


def test_a_network_learns_through_the_layer():
    """Moduli from displacements by gradient descent in logarithms."""
    forces = torch.zeros((12, 3))
    forces[-4:, 2] = 0.3
    measured = Equilibrium.apply(made, torch.tensor([4000.0, 4000.0]), forces)
    logarithms = torch.log(torch.tensor([3000.0, 5000.0])).requires_grad_()
    optimizer = torch.optim.LBFGS([logarithms], lr=0.5, max_iter=40, tolerance_grad=1e-9)

    def loss():
        optimizer.zero_grad()
        found = Equilibrium.apply(made, torch.exp(logarithms), forces)
        misfit = 1e4 * ((found - measured) ** 2).sum()
        misfit.backward()
        return misfit

    optimizer.step(loss)
    assert torch.allclose(torch.exp(logarithms), torch.tensor([4000.0, 4000.0]), rtol=0.01)
