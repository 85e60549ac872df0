"""The deck for CalculiX and the reading of its results; CalculiX itself if it is installed."""

import shutil

import numpy as np
import pytest

import calculix
from case_file import Material
from common.errors import ComputationError, InputError
from exchange import frd_file
from hexahedra import Condition, HexMesh

CORNERS = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
    dtype=float,
)
# mu = 1000 Pa, K = 2000 Pa: all numbers of the deck are exact.
MATERIAL = {"young_modulus": 18000 / 7, "poisson_ratio": 2 / 7}

FRD = """\
 -4  DISP        4    1
 -1         1 0.00000E+00 5.00000E-01-1.00000E+02
 -1         2-1.25000E-01-2.00000E-03-4.00000E-105
 -3
"""

STA = """\
SUMMARY OF JOB INFORMATION
  STEP      INC     ATT  ITRS     TOT TIME     STEP TIME      INC TIME
     1          1     1     3  0.575000E+00  0.575000E+00  0.575000E+00
     1          2     1U    4  0.575000E+00  0.575000E+00  0.425000E+00
     1          2     2     2  0.100000E+01  0.100000E+01  0.425000E+00
"""


def brick(*conditions):
    """One unit cube; conditions: (axis and side of a face, as in "x0"; components; value)."""
    return HexMesh(
        CORNERS,
        np.arange(8)[None, :],
        tuple(
            Condition(CORNERS[:, "xyz".index(at[0])] == int(at[1]), axes, np.tile(value, (8, 1)))
            for at, axes, value in conditions
        ),
    )


def test_conditions_of_a_mesh_come_into_the_deck():
    edge = Condition((CORNERS[:, 0] == 0) & (CORNERS[:, 2] == 1), (2,), np.full((8, 3), -0.125))
    held = brick(("x0", (0,), (0.0, 9.0, 9.0)))
    mesh = HexMesh(held.points, held.cells, held.conditions + (edge,))
    text = calculix.deck("one", mesh, Material("neo-hookean", MATERIAL), "C3D8R")
    imposed = text[text.index("*BOUNDARY") : text.index("*NODE FILE")].splitlines()[1:]
    held = [f"{node}, 1, 1, 0.0" for node in (1, 4, 5, 8)]
    assert sorted(imposed) == sorted([*held, "5, 3, 3, -0.125", "8, 3, 3, -0.125"])
    assert "*CONTROLS" not in text and "TYPE=C3D8R," in text


def test_deck_of_a_law_that_ccx_lacks():
    with pytest.raises(InputError, match="'glass'.*known: neo-hookean"):
        calculix.deck("t", brick(), Material("glass", MATERIAL))


def test_damaged_result_file(tmp_path):
    (tmp_path / "case.frd").write_text(FRD.replace("-4  DISP", "-4  DUMMY"))
    with pytest.raises(InputError, match="a block ' -4  DISP' is required"):
        frd_file.read_displacement(tmp_path / "case.frd", 2)


def test_progress(tmp_path):
    (tmp_path / "case.sta").write_text(STA)
    assert calculix.read_progress(tmp_path / "case.sta") == (2, 9, 1.0)


@pytest.mark.parametrize("old, new", [("1U    4", "4"), ("     2  0.1", "     ?  0.1")])
def test_damaged_progress_file(tmp_path, old, new):
    assert old in STA
    (tmp_path / "case.sta").write_text(STA.replace(old, new))
    with pytest.raises(InputError, match="seven columns"):
        calculix.read_progress(tmp_path / "case.sta")


def _stand_in(tmp_path, monkeypatch, script):
    """Replace ccx by a shell script."""
    program = tmp_path / "ccx"
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setattr(calculix, "PROGRAM", str(program))


@pytest.mark.parametrize(
    "script, told",
    [
        ("echo ' *ERROR: increment size too small'; exit 201", "201: .*increment size too small"),
        ("exit 1", "ended with 1: no message"),
        ("exit 0", "ended with 0: no message"),
        ("sed '$d' > case.sta <<'E'\n" + STA + "E\necho 'Total CalculiX Time: 1.5'", "at 0.5750"),
    ],
)
def test_failure_of_ccx_is_told(tmp_path, monkeypatch, script, told):
    _stand_in(tmp_path, monkeypatch, script)
    with pytest.raises(ComputationError, match=told):
        calculix.solve("", 2, tmp_path)


def test_what_ccx_tells_is_read(tmp_path, monkeypatch):
    (tmp_path / "frd").write_text(FRD)
    (tmp_path / "sta").write_text(STA)
    said = "echo 'CalculiX Version 2.20, Copyright'; echo 'Total CalculiX Time: 1.5'"
    _stand_in(tmp_path, monkeypatch, f"cp frd case.frd; cp sta case.sta; {said}")
    found = calculix.solve("", 2, tmp_path)
    assert found.displacement[1, 0] == -0.125
    assert (found.solver_seconds, found.version) == (1.5, "2.20")
    assert (found.increments, found.iterations) == (2, 9)


def _lateral_stretch(stretch):
    """Lateral stretch of MATERIAL in uniaxial tension: bisection of dW/dt = 0 to round-off."""
    mu, bulk = 1000.0, 2000.0

    def slope(t):  # of W = mu/2 (J^(-2/3) (s^2 + 2 t^2) - 3) + K/2 (J - 1)^2, J = s t^2
        J = stretch * t**2
        isochoric = mu / 2 * J ** (-2 / 3) * (4 * t - 4 / 3 / t * (stretch**2 + 2 * t**2))
        return isochoric + bulk * (J - 1) * 2 * stretch * t

    low, high = 0.5, 1.5
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if slope(middle) > 0 else (middle, high)
    return low


@pytest.mark.skipif(
    shutil.which(calculix.PROGRAM) is None, reason="ccx is not installed (package calculix-ccx)"
)
@pytest.mark.parametrize("element", ["C3D8", "C3D8R"])
def test_ccx_stretches_a_brick_as_the_energy_says(tmp_path, element):
    mesh = brick(
        ("x0", (0,), (0, 0, 0)),
        ("y0", (1,), (0, 0, 0)),
        ("z0", (2,), (0, 0, 0)),
        ("z1", (2,), (0, 0, 0.25)),
    )
    text = calculix.deck("tension", mesh, Material("neo-hookean", MATERIAL), element, 1e-8)
    found = calculix.solve(text, 8, tmp_path)
    lateral = _lateral_stretch(1.25)
    exact = CORNERS * [lateral - 1, lateral - 1, 0.25]
    # Six digits are written: up to 5e-6 of a number is lost. Newton's method leaves 1e-8.
    assert np.abs(found.displacement - exact).max() < 5e-6 * 0.25 + 1e-8
    assert found.increments <= found.iterations
    assert 0 < found.solver_seconds <= found.process_seconds + 0.01
