"""The exact text of the deck for CalculiX."""

import numpy as np
import pytest

from exchange import abaqus_file
from common.errors import InputError
from exchange.calculix_deck import Explicit, deck
from exchange.foreign_mesh import HexMesh

CORNERS = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
    dtype=float,
)
BRICK = HexMesh(CORNERS, np.arange(8)[None, :], {"left side": np.array([0, 3, 4, 7])})
# mu = 1500 Pa, K = 1000 Pa, to the last digit.
MATERIAL = {"young_modulus": 3000.0, "poisson_ratio": 0.0}
FREE = np.zeros((8, 3), dtype=bool)

DECK = """\
*HEADING
one brick
*NODE
1, 0.0, 0.0, 0.0
2, 1.0, 0.0, 0.0
3, 1.0, 1.0, 0.0
4, 0.0, 1.0, 0.0
5, 0.0, 0.0, 1.0
6, 1.0, 0.0, 1.0
7, 1.0, 1.0, 1.0
8, 0.0, 1.0, 1.0
*ELEMENT, TYPE=C3D8I, ELSET=ALL
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET="left side"
1, 4, 5, 8
*MATERIAL, NAME=SOLID
*HYPERELASTIC, NEO HOOKE
750.0, 0.002
*SOLID SECTION, ELSET=ALL, MATERIAL=SOLID
*STEP, NLGEOM, INC=10000
*STATIC
0.25, 1
*CONTROLS, PARAMETERS=FIELD
1e-08, 1e-08
*BOUNDARY
1, 1, 1, 0.0
5, 1, 1, 0.0
5, 3, 3, -0.125
*CLOAD
7, 2, 2.5
*NODE FILE, FREQUENCY=10000
U
*END STEP
"""


def test_deck_of_one_brick():
    prescribed, values, forces = FREE.copy(), np.zeros((8, 3)), np.zeros((8, 3))
    prescribed[[0, 4, 4], [0, 0, 2]] = True
    values[4, 2], values[6, 1] = -0.125, 9.0  # the second is not prescribed
    forces[6, 1] = 2.5
    options = {"element": "C3D8I", "forces": forces}
    text = deck("one\nbrick", BRICK, "neo-hookean", MATERIAL, prescribed, values, **options)
    assert text == DECK


def test_deck_without_tolerance_and_forces_keeps_to_what_ccx_takes():
    text = deck("t", BRICK, "neo-hookean", MATERIAL, ~FREE, np.ones((8, 3)), tolerance=None)
    assert "*CONTROLS" not in text and "*CLOAD" not in text and "TYPE=C3D8," in text


def test_deck_of_a_law_that_ccx_lacks():
    with pytest.raises(InputError, match="'glass'.*known: neo-hookean"):
        deck("t", BRICK, "glass", MATERIAL, ~FREE, np.ones((8, 3)))


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
    assert abaqus_file.number(value) == text and len(text) <= 20
    assert abs(float(text) - value) <= 5e-13 * abs(value)  # 13 digits or more


def test_deck_of_a_motion():
    prescribed, values = FREE.copy(), np.ones((8, 3))
    prescribed[2, 1] = True
    explicit = Explicit(density=1200.0, time_step=0.25, steps=6, ramp_steps=4)
    text = deck("one", BRICK, "neo-hookean", MATERIAL, prescribed, values, explicit=explicit)
    # (10 - 15 t + 6 t^2) t^3 at quarters: 53/512, 1/2, 459/512.
    assert text.endswith(
        """\
*HYPERELASTIC, NEO HOOKE
750.0, 0.002
*DENSITY
1200.0
*SOLID SECTION, ELSET=ALL, MATERIAL=SOLID
*AMPLITUDE, NAME=RAMP
0.0, 0.0
0.25, 0.103515625
0.5, 0.5
0.75, 0.896484375
1.0, 1.0
*STEP, NLGEOM, INC=60
*DYNAMIC, EXPLICIT, ALPHA=0.
0.25, 1.5, 2.5e-07, 0.25
*BOUNDARY, AMPLITUDE=RAMP
3, 2, 2, 1.0
*NODE FILE, FREQUENCY=60
U
*END STEP
"""
    )
