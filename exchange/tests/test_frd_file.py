"""Results of CalculiX are read exactly; errors in damaged files name the line."""

import numpy as np
import pytest
from meshes import DATA

from exchange import frd_file
from common.errors import InputError

# Fields touch where a number has a sign; the first block is of an earlier increment; node 3 belongs
# to no element.
FRD = (DATA / "two-nodes.frd").read_text()


@pytest.fixture
def file(tmp_path):
    (tmp_path / "case.frd").write_text(FRD)
    return tmp_path / "case.frd"


def test_last_displacements_are_read(file):
    u = [[0, 0.5, -100], [-0.125, -0.002, -4e-105]]
    points, displacement = frd_file.read(file)
    assert (points == [[9, -9, 9], [9, 9, 8]]).all()
    assert (displacement == u).all()


@pytest.mark.parametrize(
    "old, new, message",
    [
        ("-4  DISP", "-4  DUMMY", "a block ' -4  DISP' is required"),
        ("-2.00000E-03", "-2.000*0E-03", ":16: .*three numbers"),
        ("-2.00000E-03", "", ":16: .*three numbers"),
        ("-2.00000E-03", "         NaN", ":16: .*three numbers"),
        (" -1         2-1.25", " -1         1-1.25", ":17: node 1 is given twice"),
        (" -1         2-1.25", " -1         ?-1.25", ":16: .*a node number"),
        (" -1         2 9.00", " -1         4 9.00", "node 2 of the block DISP has no coord"),
        ("    2C    ", "    3C    ", "no nodes: a block '    2C'"),
        (FRD[FRD.index(" -3\n -4  STRESS") :], "", ":14: the block DISP has no end"),
        (FRD[20:], "", "no displacements"),
        (FRD, "", "no displacements"),
    ],
)
def test_damaged_file(file, old, new, message):
    assert old in FRD
    file.write_text(FRD.replace(old, new))
    with pytest.raises(InputError, match=message):
        frd_file.read(file)


def test_no_file_and_no_text(tmp_path):
    for content in (None, np.arange(200, dtype=np.uint8).tobytes()):
        if content:
            (tmp_path / "none.frd").write_bytes(content)
        with pytest.raises(InputError, match="none.frd: cannot be read as an ASCII .frd file"):
            frd_file.read(tmp_path / "none.frd")
