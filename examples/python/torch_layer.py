"""A static equilibrium as a layer of PyTorch: displacements from moduli and nodal forces.

`Equilibrium.apply(make, moduli, forces)` returns displacements (n, 3), with derivatives by both
from one adjoint problem. Only double precision is exact: float tensors are converted. Needs
python3-torch.
"""

import torch


class Equilibrium(torch.autograd.Function):
    """The displacements of a body as a function of moduli and of forces on its nodes.

    make: a function from moduli, a list of k floats in Pa, and forces, an array (n, 3) in N, to an
    `sg.Body` with k materials that have a `young_modulus`, in the same order. moduli: a tensor
    (k,). forces: a tensor (n, 3).
    """

    @staticmethod
    def forward(context, make, moduli, forces):
        """The displacements (n, 3), m. Raises what `sg.Body.solve` raises."""
        body = make(moduli.detach().double().tolist(), forces.detach().double().numpy())
        context.solution = body.solve()
        return torch.tensor(context.solution.displacement, dtype=moduli.dtype)

    @staticmethod
    def backward(context, of_displacements):
        """The derivatives by both. Raises what `sg.Solution.gradient` raises."""
        found = context.solution.gradient(of_displacements.double().numpy())
        moduli = [material["young_modulus"] for material in found.materials]
        kind = of_displacements.dtype
        return None, torch.tensor(moduli, dtype=kind), torch.tensor(found.forces, dtype=kind)
