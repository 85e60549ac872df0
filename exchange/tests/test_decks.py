"""Decks: their exact text for one brick, the constants of every law, and what is refused.

The texts in data/decks were run: ccx, FEBio, NiftySim and OpenRadioss take them, and what they
answer on the canonical cases is in results/.
"""

import math
import xml.etree.ElementTree as xml
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from common.errors import InputError
from common.hexahedron import CUBE
from exchange import abaqus_writer, decks
from exchange.decks import calculix, febio, openradioss
from exchange.decks.problem import CURVE_POINTS, Material, Motion, Problem, agreed
from exchange.foreign_mesh import HexMesh

TEXTS = Path(__file__).parent / "data/decks"
CORNERS = CUBE.astype(float)
BRICK = HexMesh(CORNERS, np.arange(8)[None, :], {"left side": np.array([0, 3, 4, 7])})
ALL = np.arange(1)
# mu = 1500 Pa, K = 1000 Pa, to the last digit.
NEO_HOOKEAN = Material(
    "neo-hookean",
    {"young_modulus": 3000.0, "poisson_ratio": 0.0},
    density=1200.0,
    shear_modulus=1500.0,
    bulk_modulus=1000.0,
    volumetric="quadratic",
    elements=ALL,
)


def made_of(law, parameters):
    """A material of mu = 10 Pa and K = 400 Pa by a law."""
    moduli = {"shear_modulus": 10.0, "bulk_modulus": 400.0}
    return replace(NEO_HOOKEAN, law=law, parameters=parameters, **moduli)


def problem(motion=None, force=2.5, held=(0, 1, 2)):
    """The foot of node 0 and all of node 4 are imposed; node 4 moves down, node 6 is pulled."""
    prescribed, values, forces = np.zeros((8, 3), dtype=bool), np.zeros((8, 3)), np.zeros((8, 3))
    prescribed[0, list(held)] = prescribed[4] = True
    values[4, 2], values[6, 1] = -0.125, 9.0  # the second is not prescribed
    forces[6, 1] = force
    return Problem("one\nbrick", BRICK, [NEO_HOOKEAN], prescribed, values, forces, motion, 0.125)


def texts(name, ending, one, **options):
    """{name of file: text} of a deck called brick."""
    found = decks.files(name, one, Path(f"brick{ending}"), **options)
    return {path.name: text for path, text in found.items()}


DAMPED = Motion(time_step=0.25, steps=4, ramp_steps=4, damping=0.5)
WRITTEN = {
    "static.inp": ("calculix", ".inp", problem(), {"element": "C3D8I"}),
    "static.feb": ("febio", ".feb", problem(), {}),
    "moved.feb": ("febio", ".feb", problem(DAMPED), {"element": "udg-hex", "hourglass": 0.5}),
    "moved.xml": ("niftysim", ".xml", problem(DAMPED), {}),
    "moved_0000.rad": ("openradioss", "_0000.rad", problem(DAMPED), {}),
}


@pytest.mark.parametrize("name", WRITTEN)
def test_decks_of_one_brick(name):
    program, ending, one, options = WRITTEN[name]
    for file, text in texts(program, ending, one, **options).items():
        assert text == (TEXTS / file.replace("brick", name.split(".")[0].split("_")[0])).read_text()


def test_the_loading_curve_is_the_nearest_double_on_every_processor():
    """Powers by numpy were not: with AVX-512 they round otherwise than without."""
    times, factors = DAMPED.curve()
    parts = [Fraction(k, CURVE_POINTS - 1) for k in range(CURVE_POINTS)]
    assert factors.tolist() == [float((10 - 15 * t + 6 * t**2) * t**3) for t in parts]
    assert times.tolist() == [float(t) for t in parts]  # of a ramp of one second


def test_numbers_that_round_otherwise_elsewhere_are_written_alike():
    """The last bit of an exponential, and several of a determinant, depend on the processor."""
    for value in (math.exp(-0.125), 1200.0, 2 / 3):
        near = [value * (1 + k * np.finfo(float).eps) for k in range(-4, 5)]
        assert len(set(map(agreed, near))) == 1
        assert agreed(value) == pytest.approx(value, rel=5e-12)  # half of the twelfth digit


def test_deck_of_a_motion_for_calculix():
    moved = problem(Motion(time_step=0.25, steps=6, ramp_steps=4), force=0.0, held=())
    (text,) = texts("calculix", ".inp", moved).values()
    # (10 - 15 t + 6 t^2) t^3 at quarters: 53/512, 1/2, 459/512.
    assert text.endswith((TEXTS / "moved-ending.inp").read_text())


MOONEY = {"c10": 3.0, "c01": 2.0, "bulk_modulus": 400.0}
OGDEN = {"mu1": 6.0, "alpha1": 4.0, "mu2": 4.0, "alpha2": -2.0, "bulk_modulus": 400.0}


def test_laws_of_febio():
    """Ogden: sum c / m^2 (l1^m + ...) where Sandglass has 2 mu / alpha^2. Yeoh: sum c / i x^i."""

    def of(law, parameters):
        return febio.LAWS[law](made_of(law, parameters))

    assert of("neo-hookean", {}) == ("Mooney-Rivlin", {"c1": 5.0, "c2": 0.0})
    assert of("mooney-rivlin", MOONEY) == ("Mooney-Rivlin", {"c1": 3.0, "c2": 2.0})
    yeoh = {"c1": 5.0, "c2": 0.5, "c3": 0.25, "bulk_modulus": 400.0}
    assert of("yeoh", yeoh) == ("Yeoh", {"c1": 5.0, "c2": 1.0, "c3": 0.75})
    assert of("ogden", OGDEN) == ("Ogden", {"c1": 12.0, "m1": 4.0, "c2": 8.0, "m2": -2.0})
    with pytest.raises(InputError, match="exponent of 0"):
        of("ogden", OGDEN | {"alpha1": 0.0})


def test_laws_of_openradioss():
    """W = sum mu / alpha (l1^alpha + ...): 2 mu / alpha^2 of Sandglass is mu' / alpha."""

    def of(law, parameters):
        return openradioss.LAWS[law](made_of(law, parameters))

    assert of("neo-hookean", {}) == [(10.0, 2.0)]
    # I2bar - 3 is the sum of l^-2: mu / alpha = c01.
    assert of("mooney-rivlin", MOONEY) == [(6.0, 2.0), (-4.0, -2.0)]
    assert of("ogden", OGDEN) == [(3.0, 4.0), (-4.0, -2.0)]
    assert of("ogden", OGDEN | {"mu2": 0.0}) == [(3.0, 4.0)]


def test_poisson_ratio_of_openradioss_gives_the_bulk_modulus():
    material = made_of("mooney-rivlin", MOONEY)
    (text, _) = texts("openradioss", "_0000.rad", replace(problem(), materials=[material])).values()
    lines = text.splitlines()
    poisson = float(lines[lines.index("/MAT/LAW42/1") + 3][:20])
    # mu = 2 (c10 + c01) = 10 Pa; K = 2 mu (1 + nu) / 3 / (1 - 2 nu).
    assert 20 * (1 + poisson) / 3 / (1 - 2 * poisson) == pytest.approx(400.0, rel=1e-12)


def test_laws_of_calculix():
    material = made_of("mooney-rivlin", MOONEY)
    (text,) = texts("calculix", ".inp", replace(problem(), materials=[material])).values()
    assert "*HYPERELASTIC, MOONEY-RIVLIN\n3.0, 2.0, 0.005\n" in text


def two_materials():
    """Two bricks on top of each other, the upper of another material."""
    points = np.vstack([CORNERS, CORNERS[4:] + [0, 0, 1]])
    mesh = HexMesh(points, np.array([np.arange(8), np.arange(4, 12)]), {})
    moduli = {"shear_modulus": 150.0, "bulk_modulus": 100.0}
    upper = replace(NEO_HOOKEAN, density=900.0, elements=np.array([1]), **moduli)
    shape, materials = (12, 3), [NEO_HOOKEAN, upper]
    fields = np.zeros(shape, dtype=bool), np.zeros(shape), np.zeros(shape)
    return Problem("two", mesh, materials, *fields, DAMPED, 0.125)


def test_each_element_has_its_material():
    two = two_materials()
    (text,) = texts("niftysim", ".xml", two).values()
    sets = xml.fromstring(text).findall("ElementSet")
    assert [one.find("Material").tail.split() for one in sets] == [["0"], ["1"]]
    assert [one.findtext("Material/ElasticParams") for one in sets] == [
        "1500.0 1000.0",
        "150.0 100.0",
    ]
    assert [one.findtext("Material/Density") for one in sets] == ["1200.0", "900.0"]
    (text,) = texts("febio", ".feb", two).values()
    root = xml.fromstring(text)
    assert [one.find("elem").get("id") for one in root.findall("Mesh/Elements")] == ["1", "2"]
    found = [(one.get("name"), one.get("mat")) for one in root.findall("MeshDomains/SolidDomain")]
    assert found == [("part1", "material1"), ("part2", "material2")]
    assert [one.findtext("c1") for one in root.findall("Material/material")] == ["750.0", "75.0"]
    text, _ = texts("openradioss", "_0000.rad", two).values()
    assert f"/BRICK/2\n{2:10d}" + "".join(f"{n:10d}" for n in range(5, 13)) in text
    assert f"/PART/2\npart 2\n{2:10d}{2:10d}" in text
    (text,) = texts("calculix", ".inp", replace(two, motion=None)).values()
    assert "*ELSET, ELSET=MADE_OF_2\n2\n*MATERIAL, NAME=SOLID2\n" in text
    assert "*SOLID SECTION, ELSET=MADE_OF_2, MATERIAL=SOLID2" in text


def test_a_quasi_static_case_becomes_a_damped_motion():
    """The shear wave crosses the diagonal of sqrt(3) m at sqrt(1500/1200) m/s."""
    motion = problem().relaxation()
    crossing = np.sqrt(3 / (1500 / 1200))
    assert motion.time_step == pytest.approx(0.1) and motion.ramp_steps == motion.steps
    assert 20 * crossing <= motion.duration < 20 * crossing + 0.1
    assert motion.damping == pytest.approx(2 / crossing)


@pytest.mark.parametrize(
    "program, ending, one, options, message",
    [
        ("abaqus", ".inp", problem(), {}, "--deck abaqus: .*known: calculix, febio, niftysim"),
        ("calculix", ".xml", problem(), {}, r"brick.xml: a deck for CalculiX ends in .inp"),
        ("calculix", ".inp", problem(), {"element": "C3D9"}, "did you mean 'C3D8'"),
        ("calculix", ".inp", problem(), {"hourglass": 1.0}, "have no hourglass coefficient"),
        ("calculix", ".inp", problem(DAMPED), {}, "have no damping"),
        ("febio", ".feb", problem(), {"hourglass": 1.0}, "three-field-solid has no hourglass"),
        (
            "niftysim",
            ".xml",
            problem(Motion(0.25, 6, 4)),
            {},
            "lasts as long as the motion: ramp_time = duration",
        ),
    ],
)
def test_unsupported_features_are_refused(program, ending, one, options, message):
    with pytest.raises(InputError, match=message):
        texts(program, ending, one, **options)


@pytest.mark.parametrize("program", decks.PROGRAMS)
@pytest.mark.parametrize("key, value", [("law", "guccione"), ("volumetric", "glass")])
def test_unknown_materials_are_refused_by_every_program(program, key, value):
    other = replace(problem(force=0.0), materials=[replace(NEO_HOOKEAN, **{key: value})])
    with pytest.raises(InputError, match=f"material.{key} = '{value}' is not known to"):
        texts(program, decks.PROGRAMS[program].ENDING, other)


@pytest.mark.parametrize(
    "value, text",
    [
        (0.1, "0.1"),
        (-1 / 15, "-0.06666666666666667"),
        (-1 / 3e100, "-3.333333333333e-101"),
        (1 / 3e10, "3.3333333333333e-11"),
        (-1e99 / 3, "-3.3333333333333e+98"),
    ],
)
def test_numbers_have_no_more_than_the_20_characters_that_are_read(value, text):
    assert abaqus_writer.number(value) == text and len(text) <= 20
    assert abs(float(text) - value) <= 5e-13 * abs(value)  # 13 digits or more


def test_increments_suffice_for_an_element_that_needs_shorter_steps():
    (text,) = texts("calculix", ".inp", problem(Motion(0.25, 6, 4), force=0.0)).values()
    assert f"INC={calculix.SHORTER * 6}\n" in text
