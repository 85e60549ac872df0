"""The material laws of the reference: their names and mixed energy densities, in UFL.

A law is a function of the deformation gradient F (3x3, dimensionless), the pressure-like
multiplier p (Pa, positive in tension) and, as keyword arguments, the entries of the case's
`[material]` table other than `law` and `density`, under the same names (SI). It returns the energy
per undeformed volume (J/m^3) whose stationary point in (u, p) is the equilibrium.
It must be concave in p (the term -p^2/(2K)), because p is eliminated element by element.

To add a law, write its function and add one entry to LAWS.
"""

import inspect

import ufl


def neo_hookean(F, p, *, young_modulus, poisson_ratio):
    """Nearly incompressible neo-Hookean solid as in Abaqus and in the TLED paper.

    W = mu/2 (J^(-2/3) tr(F^T F) - 3) + p (J - 1) - p^2 / (2 K); eliminating p pointwise
    (p = K (J - 1)) gives mu/2 (J^(-2/3) tr(F^T F) - 3) + K/2 (J - 1)^2.
    """
    mu, K = _moduli(young_modulus, poisson_ratio)
    J = ufl.det(F)
    return mu / 2 * (J ** (-2 / 3) * ufl.inner(F, F) - 3) + _volumetric(J, p, K)


def st_venant_kirchhoff(F, p, *, young_modulus, poisson_ratio):
    """Hooke's law in terms of the Green strain E, lambda/2 tr^2 E + mu E : E.

    It does not split into an isochoric and a volumetric part: K/2 (J - 1)^2 is subtracted from the
    energy and replaced by the pressure terms.
    """
    mu, K = _moduli(young_modulus, poisson_ratio)
    E, J = (F.T * F - ufl.Identity(3)) / 2, ufl.det(F)
    energy = (K - 2 * mu / 3) / 2 * ufl.tr(E) ** 2 + mu * ufl.inner(E, E)
    return energy - K / 2 * (J - 1) ** 2 + _volumetric(J, p, K)


def mooney_rivlin(F, p, *, c10, c01, bulk_modulus):
    """Linear in the isochoric invariants, c10 (I1bar - 3) + c01 (I2bar - 3)."""
    C, J = F.T * F, ufl.det(F)
    I1, I2 = ufl.tr(C), (ufl.tr(C) ** 2 - ufl.tr(C * C)) / 2
    energy = c10 * (J ** (-2 / 3) * I1 - 3) + c01 * (J ** (-4 / 3) * I2 - 3)
    return energy + _volumetric(J, p, bulk_modulus)


def yeoh(F, p, *, c1, c2, c3, bulk_modulus):
    """Cubic in the first isochoric invariant, c1 x + c2 x^2 + c3 x^3 with x = I1bar - 3."""
    J = ufl.det(F)
    x = J ** (-2 / 3) * ufl.inner(F, F) - 3
    return c1 * x + c2 * x**2 + c3 * x**3 + _volumetric(J, p, bulk_modulus)


def fibre_neo_hookean(F, p, *, young_modulus, poisson_ratio, fibre_modulus, fibre_direction):
    """Neo-Hookean with a fibre family, k/2 ((I4bar - 1)/2)^2; the direction may have any length."""
    a, J = fibre_direction, ufl.det(F)
    strain = (J ** (-2 / 3) * ufl.inner(F * a, F * a) / ufl.inner(a, a) - 1) / 2
    matrix = neo_hookean(F, p, young_modulus=young_modulus, poisson_ratio=poisson_ratio)
    return matrix + fibre_modulus / 2 * strain**2


def _moduli(E, nu):
    """Shear and bulk modulus, Pa."""
    return E / 2 / (1 + nu), E / 3 / (1 - 2 * nu)


def _volumetric(J, p, K):
    """K/2 (J - 1)^2 with its derivative p as a separate unknown."""
    return p * (J - 1) - p**2 / (2 * K)


def viscoelastic(law):
    """The law after complete stress relaxation, which gives the quasi-static answer.

    The isochoric stress, whose energy is the law's at p = 0, retains the share
    1 - relaxation_1 - relaxation_2 (Simo 1987); the volumetric stress does not relax.
    """

    def relaxed(F, p, *, relaxation_1, time_1, relaxation_2=0.0, time_2=0.0, **material):
        share = relaxation_1 + relaxation_2
        return law(F, p, **material) - share * law(F, 0, **material)

    return relaxed


LAWS = {
    "neo-hookean": neo_hookean,
    "st-venant-kirchhoff": st_venant_kirchhoff,
    "mooney-rivlin": mooney_rivlin,
    "yeoh": yeoh,
    "fibre-neo-hookean": fibre_neo_hookean,
}

VISCOELASTIC = "viscoelastic-"
LAWS |= {VISCOELASTIC + name: viscoelastic(law) for name, law in LAWS.items()}


def parameters(law):
    """A law's parameters as named in a case file's `[material]`: name -> whether it is required."""
    arguments = inspect.getfullargspec(LAWS[law])
    own = {name: name not in (arguments.kwonlydefaults or {}) for name in arguments.kwonlyargs}
    return (parameters(law.removeprefix(VISCOELASTIC)) if arguments.varkw else {}) | own
