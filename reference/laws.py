"""The one list of material laws: a name and its mixed energy density, in UFL.

A law is a function of the deformation gradient F (3x3, dimensionless), the pressure-like
multiplier p (Pa, positive in tension) and the numbers of the case's `[material]` table. It returns
the energy per undeformed volume (J/m^3) whose stationary point in (u, p) is the equilibrium.
It must be concave in p (the term -p^2/(2K)), because p is eliminated element by element.

To add a law, write its function and add one entry to LAWS.
"""

import ufl


def neo_hookean(F, p, material):
    """Nearly incompressible neo-Hookean solid, the one of ABAQUS and of the TLED paper.

    W = mu/2 (J^(-2/3) tr(F^T F) - 3) + p (J - 1) - p^2 / (2 K); eliminating p pointwise
    (p = K (J - 1)) gives back mu/2 (J^(-2/3) tr(F^T F) - 3) + K/2 (J - 1)^2.
    """
    E, nu = material["young_modulus"], material["poisson_ratio"]
    mu, K = E / 2 / (1 + nu), E / 3 / (1 - 2 * nu)
    J = ufl.det(F)
    return mu / 2 * (J ** (-2 / 3) * ufl.inner(F, F) - 3) + p * (J - 1) - p**2 / (2 * K)


def viscoelastic(law):
    """The same law when all that relaxes has relaxed: its quasi-static answer.

    The isochoric stress, whose energy is what is left at p = 0, keeps the share
    1 - relaxation_1 - relaxation_2 (Simo 1987); the volumetric one does not relax.
    """

    def relaxed(F, p, material):
        share = material["relaxation_1"] + material.get("relaxation_2", 0.0)
        return law(F, p, material) - share * law(F, 0, material)

    return relaxed


LAWS = {
    "neo-hookean": neo_hookean,
}

LAWS |= {"viscoelastic-" + name: viscoelastic(law) for name, law in LAWS.items()}
