"""Formulas of the time: exact values, the same as in C++ (verification/formula_test.cpp)."""

import pytest

import formula
from blocks import CASE
from case_file import read_case
from common.errors import InputError
from common.files import read_toml
from common.program import ROOT

FORMULAS = read_toml(ROOT / "verification" / "formulas.toml")


@pytest.mark.parametrize("one", FORMULAS["good"], ids=lambda one: one["formula"])
def test_values_are_those_of_40_digits(one):
    """A few roundings of numbers near one; C++ has the same tolerance."""
    for t, value in zip(FORMULAS["times"], one["values"], strict=True):
        assert abs(formula.evaluate(one["formula"], t) - value) < 1e-15 * max(1, abs(value))


@pytest.mark.parametrize("one", FORMULAS["wrong"], ids=lambda one: one["formula"])
def test_invalid_formulas_are_refused(one):
    with pytest.raises(InputError, match="formula"):
        formula.evaluate(one["formula"], 0.0)


def test_a_load_has_its_factor_at_the_end(tmp_path):
    path = tmp_path / "case.toml"
    load = '\n[[pressure]]\nset = "top"\nvalue = 10.0\nformula = "sin(pi*t/2) + {}"\n'
    path.write_text(CASE + load.format("t"))
    assert read_case(path).pressures[0].value == 20.0
    path.write_text(CASE + load.format("x"))
    with pytest.raises(InputError, match=r"pressure\[0\]?.*formula.*'x' is not allowed"):
        read_case(path)
