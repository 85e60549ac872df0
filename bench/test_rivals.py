"""How other programs are run and their output is read; CalculiX itself if installed."""

import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq

from common.errors import ComputationError, InputError
from common.hexahedron import CUBE
from exchange import decks, frd_file
from exchange.decks.problem import Material, Problem
from exchange.foreign_mesh import HexMesh
from rivals import PROGRAMS
from rivals.calculix import PROGRAM, CalculiX, read_progress
from rivals.febio import FEBio
from rivals.niftysim import NiftySim
from rivals.openradioss import OpenRadioss

CORNERS = CUBE.astype(float)

FRD = """\
    2C
 -1         1 0.00000E+00 0.00000E+00 0.00000E+00
 -1         2 1.00000E+00 0.00000E+00 0.00000E+00
 -3
  100CL  101 1.50000E+00           2                     0    1           1
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


def stand_in(folder, kind, script, executables=1):
    """A program whose executables are a shell script, in a folder with its deck: (it, the deck)."""
    paths = []
    for i in range(executables):
        path = folder / f"program{i}"
        path.write_text(f"#!/bin/sh\n{script}\n")
        path.chmod(0o755)
        paths.append(str(path))
    deck = folder / f"case{decks.PROGRAMS[kind.deck].ENDING}"
    deck.touch()
    return kind(paths), deck


def test_progress(tmp_path):
    (tmp_path / "case.sta").write_text(STA)
    assert read_progress(tmp_path / "case.sta") == (2, 9, 1.0)


@pytest.mark.parametrize("old, new", [("1U    4", "4"), ("     2  0.1", "     ?  0.1")])
def test_damaged_progress_file(tmp_path, old, new):
    assert old in STA
    (tmp_path / "case.sta").write_text(STA.replace(old, new))
    with pytest.raises(InputError, match="seven columns"):
        read_progress(tmp_path / "case.sta")


@pytest.mark.parametrize(
    "script, message",
    [
        ("echo ' *ERROR: increment size too small'; exit 201", "201: .*increment size too small"),
        ("exit 1", "ended with 1: no message"),
        ("exit 0", "ended with 0: no message"),
        ("sed '$d' > case.sta <<'E'\n" + STA + "E\necho 'Total CalculiX Time: 1.5'", "at 0.5750"),
    ],
)
def test_failure_of_ccx_is_reported(tmp_path, script, message):
    program, deck = stand_in(tmp_path, CalculiX, script)
    with pytest.raises(ComputationError, match=message):
        program.run(deck, None)


def test_output_of_ccx_is_read(tmp_path):
    (tmp_path / "frd").write_text(FRD)
    (tmp_path / "sta").write_text(STA)
    said = "echo 'CalculiX Version 2.20, Copyright'; echo 'Total CalculiX Time: 1.5'"
    program, deck = stand_in(tmp_path, CalculiX, f"cp frd case.frd; cp sta case.sta; {said}")
    found = program.run(deck, None)
    assert frd_file.read(found.answer)[1][1, 0] == -0.125
    assert (found.steps, found.iterations, program.version) == (2, 9, "2.20")


@pytest.mark.parametrize(
    "motion, message", [((0.5, 3), None), ((0.5, 4), "at 1.50000E.00 s of 2 s")]
)
def test_a_motion_of_ccx_must_reach_its_end(tmp_path, motion, message):
    """1.5 s in steps of .25 s: half of those requested."""
    (tmp_path / "frd").write_text(FRD)
    said = "echo 'SELECTED time increment: 0.25'; echo 'Total CalculiX Time: 1.5'"
    program, deck = stand_in(tmp_path, CalculiX, f"cp frd case.frd; {said}")
    if message is None:
        assert program.run(deck, motion).steps == 6
    else:
        with pytest.raises(ComputationError, match=message):
            program.run(deck, motion)


DIVERGES = "echo '!!!Divergence after 12 steps -> reduce time step.'; touch U.txt; exit 1"


@pytest.mark.parametrize(
    "script, message",
    [(DIVERGES, "NiftySim: Divergence after 12 steps"), ("exit 0", "NiftySim: no answer")],
)
def test_failure_of_niftysim_is_reported(tmp_path, script, message):
    program, deck = stand_in(tmp_path, NiftySim, script)
    with pytest.raises(ComputationError, match=message):
        program.run(deck, (0.5, 3))


def test_niftysim_takes_the_steps_of_its_deck(tmp_path):
    program, deck = stand_in(tmp_path, NiftySim, 'test "$1 $2" = "-x case.xml" && touch U.txt')
    found = program.run(deck, (0.5, 3))
    assert found.steps == 3 and found.answer.name == "U.txt"


RADIOSS = """\
if [ "$2" = case_0000.rad ]; then touch case_0000_0001.rst; exit; fi
cat > case_0001.out <<'E'
     NORMAL TERMINATION
     TOTAL NUMBER OF CYCLES  :      42
E
touch caseA001 caseA002
"""


def test_openradioss_runs_starter_and_engine(tmp_path, monkeypatch):
    monkeypatch.setenv("RAD_CFG_PATH", str(tmp_path))
    program, deck = stand_in(tmp_path, OpenRadioss, RADIOSS, executables=2)
    found = program.run(deck, (0.5, 40))
    assert found.steps == 42 and found.answer.name == "caseA002"
    broken = RADIOSS.replace("     NORMAL", "WARNING ZERO OR NEGATIVE VOLUME\n     NORMAL")
    program, deck = stand_in(tmp_path, OpenRadioss, broken, executables=2)
    with pytest.raises(ComputationError, match="OpenRadioss: zero or negative volume"):
        program.run(deck, (0.5, 40))
    program, deck = stand_in(tmp_path, OpenRadioss, "rm -f *.rst; echo ERROR ID : 7; exit 2", 2)
    with pytest.raises(ComputationError, match="OpenRadioss: ERROR ID : 7"):
        program.run(deck, (0.5, 40))


def test_openradioss_needs_both_executables_and_its_configuration(tmp_path, monkeypatch):
    monkeypatch.setenv("RAD_CFG_PATH", str(tmp_path))
    with pytest.raises(InputError, match="needs both executables"):
        stand_in(tmp_path, OpenRadioss, "exit 0")
    monkeypatch.delenv("RAD_CFG_PATH")
    with pytest.raises(InputError, match="RAD_CFG_PATH"):
        stand_in(tmp_path, OpenRadioss, "exit 0", executables=2)


@pytest.mark.parametrize("program", [PROGRAMS[name] for name in decks.PROGRAMS])
def test_every_program_has_decks_for_its_elements(program):
    known = decks.PROGRAMS[program.deck]
    assert known.NAME == program.name
    for element in program.elements(program, SimpleNamespace(kappa=0.01)):
        assert element.name in known.ELEMENTS


def test_a_program_that_is_missing(tmp_path):
    with pytest.raises(InputError, match="--program febio=.*none: no such file"):
        FEBio([str(tmp_path / "none")])


# mu = 1000 Pa, K = 2000 Pa: all numbers of the deck are exact.
MATERIAL = Material(
    "neo-hookean",
    {"young_modulus": 18000 / 7, "poisson_ratio": 2 / 7},
    density=1000.0,
    shear_modulus=1000.0,
    bulk_modulus=2000.0,
    volumetric="quadratic",
    elements=np.arange(1),
)


def _lateral_stretch(stretch):
    """Lateral stretch of MATERIAL in uniaxial tension: dW/dt = 0 to round-off."""
    mu, bulk = 1000.0, 2000.0

    def slope(t):  # of W = mu/2 (J^(-2/3) (s^2 + 2 t^2) - 3) + K/2 (J - 1)^2, J = s t^2
        J = stretch * t**2
        isochoric = mu / 2 * J ** (-2 / 3) * (4 * t - 4 / 3 / t * (stretch**2 + 2 * t**2))
        return isochoric + bulk * (J - 1) * 2 * stretch * t

    return brentq(slope, 0.5, 1.5, xtol=1e-15)


@pytest.mark.skipif(
    shutil.which(PROGRAM) is None, reason="ccx is not installed (package calculix-ccx)"
)
@pytest.mark.parametrize("element", ["C3D8", "C3D8R"])
def test_ccx_stretches_a_brick_as_the_energy_says(tmp_path, element):
    prescribed, values = CORNERS == 0, np.zeros((8, 3))
    prescribed[CORNERS[:, 2] == 1, 2], values[CORNERS[:, 2] == 1, 2] = True, 0.25
    mesh, free = HexMesh(CORNERS, np.arange(8)[None, :], {}), np.zeros((8, 3))
    problem = Problem("tension", mesh, [MATERIAL], prescribed, values, free, None, 0.1)
    files = decks.files("calculix", problem, Path(tmp_path / "case.inp"), element)
    for deck, text in files.items():
        deck.write_text(text)
    program = CalculiX([shutil.which(PROGRAM)])
    found = program.run(deck, None)
    lateral = _lateral_stretch(1.25)
    exact = CORNERS * [lateral - 1, lateral - 1, 0.25]
    # Six digits are written, a loss of up to 5e-6 of a number. Newton's method leaves 1e-8.
    assert np.abs(frd_file.read(found.answer)[1] - exact).max() < 5e-6 * 0.25 + 1e-8
    assert found.steps <= found.iterations
