"""The material laws of the reference: their names and mixed energy densities, in UFL.

A law is a function of the deformation gradient F (3x3, dimensionless), in material axes if it has
fibres, and, as keyword arguments, the entries of the case's `[material]` table that are its own,
under the same names (SI). It returns its isochoric energy per undeformed volume (J/m^3) and its
bulk modulus (Pa); a material adds one of VOLUMES.

To add a law, write its function and add one entry to LAWS.
"""

import inspect

import ufl


def neo_hookean(F, *, young_modulus, poisson_ratio):
    """Nearly incompressible neo-Hookean solid as in Abaqus and in the TLED paper,
    mu/2 (J^(-2/3) tr(F^T F) - 3).
    """
    mu, K = _moduli(young_modulus, poisson_ratio)
    return mu / 2 * (_first_invariant(F) - 3), K


def st_venant_kirchhoff(F, *, young_modulus, poisson_ratio):
    """Hooke's law in terms of the Green strain E, lambda/2 tr^2 E + mu E : E.

    It does not split into an isochoric and a volumetric part: K/2 (J - 1)^2 is subtracted from the
    energy, and the volumetric part adds it again.
    """
    mu, K = _moduli(young_modulus, poisson_ratio)
    E, J = (F.T * F - ufl.Identity(3)) / 2, ufl.det(F)
    energy = (K - 2 * mu / 3) / 2 * ufl.tr(E) ** 2 + mu * ufl.inner(E, E)
    return energy - K / 2 * (J - 1) ** 2, K


def compressible_neo_hookean(F, *, young_modulus, poisson_ratio):
    """The law of Bonet and Wood, mu/2 (tr(F^T F) - 3) - mu ln J + lambda/2 (ln J)^2.

    It does not split either.
    """
    mu, K = _moduli(young_modulus, poisson_ratio)
    log_J = ufl.ln(ufl.det(F))
    energy = mu / 2 * (ufl.inner(F, F) - 3) - mu * log_J + (K - 2 * mu / 3) / 2 * log_J**2
    return energy - K / 2 * (ufl.det(F) - 1) ** 2, K


def mooney_rivlin(F, *, c10, c01, bulk_modulus):
    """Linear in the isochoric invariants, c10 (I1bar - 3) + c01 (I2bar - 3)."""
    C, J = F.T * F, ufl.det(F)
    I1, I2 = ufl.tr(C), (ufl.tr(C) ** 2 - ufl.tr(C * C)) / 2
    return c10 * (J ** (-2 / 3) * I1 - 3) + c01 * (J ** (-4 / 3) * I2 - 3), bulk_modulus


def yeoh(F, *, c1, c2, c3, bulk_modulus):
    """Cubic in the first isochoric invariant, c1 x + c2 x^2 + c3 x^3 with x = I1bar - 3."""
    x = _first_invariant(F) - 3
    return c1 * x + c2 * x**2 + c3 * x**3, bulk_modulus


def fibre_neo_hookean(F, *, young_modulus, poisson_ratio, fibre_modulus):
    """Neo-Hookean with a fibre family, k/2 E11^2."""
    matrix, K = neo_hookean(F, young_modulus=young_modulus, poisson_ratio=poisson_ratio)
    return matrix + fibre_modulus / 2 * _isochoric_strain(F)[0, 0] ** 2, K


def guccione(F, *, stiffness, b_fibre, b_transverse, b_shear, bulk_modulus):
    """Exponential of a quadratic form of the isochoric Green strain, C/2 (exp(Q) - 1)."""
    E = _isochoric_strain(F)
    across = E[1, 1] ** 2 + E[2, 2] ** 2 + 2 * E[1, 2] ** 2
    shear = 2 * (E[0, 1] ** 2 + E[0, 2] ** 2)
    Q = b_fibre * E[0, 0] ** 2 + b_transverse * across + b_shear * shear
    return stiffness / 2 * (ufl.exp(Q) - 1), bulk_modulus


def holzapfel_ogden(F, *, a, b, a_f, b_f, a_s, b_s, a_fs, b_fs, bulk_modulus):
    """A matrix, fibres and sheets that resist only stretch, and their shear, each exponential."""
    E = _isochoric_strain(F)

    def term(stiffness, exponent, x):
        return stiffness / (2 * exponent) * (ufl.exp(exponent * x**2) - 1)

    def stretched(strain):  # I4bar - 1
        return ufl.conditional(ufl.ge(strain, 0), 2 * strain, 0)

    return (
        a / (2 * b) * (ufl.exp(b * (_first_invariant(F) - 3)) - 1)
        + term(a_f, b_f, stretched(E[0, 0]))
        + term(a_s, b_s, stretched(E[1, 1]))
        + term(a_fs, b_fs, 2 * E[0, 1])
    ), bulk_modulus


def _moduli(E, nu):
    """Shear and bulk modulus, Pa."""
    return E / 2 / (1 + nu), E / 3 / (1 - 2 * nu)


def _first_invariant(F):
    """J^(-2/3) tr(F^T F)."""
    return ufl.det(F) ** (-2 / 3) * ufl.inner(F, F)


def _isochoric_strain(F):
    """The isochoric Green strain (J^(-2/3) F^T F - I)/2."""
    return (ufl.det(F) ** (-2 / 3) * F.T * F - ufl.Identity(3)) / 2


def viscoelastic(law):
    """The law after complete stress relaxation, which gives the quasi-static answer.

    The isochoric stress retains the share 1 - relaxation_1 - relaxation_2 (Simo 1987); the
    volumetric stress does not relax.
    """

    def relaxed(F, *, relaxation_1, time_1, relaxation_2=0.0, time_2=0.0, **material):
        isochoric, K = law(F, **material)
        return (1 - relaxation_1 - relaxation_2) * isochoric, K

    return relaxed


LAWS = {
    "neo-hookean": neo_hookean,
    "st-venant-kirchhoff": st_venant_kirchhoff,
    "mooney-rivlin": mooney_rivlin,
    "yeoh": yeoh,
    "fibre-neo-hookean": fibre_neo_hookean,
    "guccione": guccione,
    "holzapfel-ogden": holzapfel_ogden,
    "compressible-neo-hookean": compressible_neo_hookean,
}

VISCOELASTIC = "viscoelastic-"
LAWS |= {VISCOELASTIC + name: viscoelastic(law) for name, law in LAWS.items()}

# Volumetric energies over the bulk modulus, functions of J with u'' = 1 at J = 1.
VOLUMES = {
    "quadratic": lambda J: (J - 1) ** 2 / 2,
    "logarithmic": lambda J: ufl.ln(J) ** 2 / 2,
    "quadratic-logarithmic": lambda J: (J**2 - 1 - 2 * ufl.ln(J)) / 4,
}


def energy(law, volume, F, p, **parameters):
    """The energy per undeformed volume (J/m^3) whose stationary point in (u, p) is the equilibrium.

    law: a name in LAWS. volume: a name in VOLUMES. p: a multiplier in Pa, K (theta - 1) of the
    volume ratio theta that it stands for: U'(theta) (J - theta) + U(theta), U = K u, is stationary
    where theta = J. With the quadratic part this is p (J - 1) - p^2 / (2 K), p the pressure.
    """
    isochoric, K = LAWS[law](F, **parameters)
    theta = ufl.variable(1 + p / K)
    u = VOLUMES[volume](theta)
    return isochoric + K * (ufl.diff(u, theta) * (ufl.det(F) - theta) + u)


def young_modulus(law, parameters):
    """Young's modulus of a law near the undeformed state, Pa; of one with fibres, across them."""

    def isochoric(stretch):
        F = ufl.as_matrix([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, stretch]])
        return LAWS[law](F, **parameters)[0](())

    h = 1e-4
    mu = 0.75 * (isochoric(1 + h) - 2 * isochoric(1.0) + isochoric(1 - h)) / h**2
    bulk = LAWS[law](ufl.Identity(3), **parameters)[1]
    return 9 * bulk * mu / (3 * bulk + mu)


def parameters(law):
    """A law's parameters as named in a case file's `[material]`: name -> whether it is required."""
    arguments = inspect.getfullargspec(LAWS[law])
    own = {name: name not in (arguments.kwonlydefaults or {}) for name in arguments.kwonlyargs}
    return (parameters(law.removeprefix(VISCOELASTIC)) if arguments.varkw else {}) | own
