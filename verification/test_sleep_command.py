"""`sandglass run --sleep`: its output and files, and rejected input."""

import h5py
import pytest
from command_line import BLOCK, sandglass

from common.result_file import last_displacement

# Long and thin, pulled at one end: the motion does not reach the other.
BEAM = (
    BLOCK.replace("size = [0.1, 0.1, 0.2]", "size = [0.1, 0.1, 3.0]")
    .replace("elements = [2, 2, 4]", "elements = [2, 2, 60]")
    .replace("foot = { z = [0.0, 0.0] }", "foot = { x = [0.0, 0.0] }")
    .replace("head = { z = [0.2, 0.2] }", "head = { x = [0.1, 0.1], z = [3.0, 3.0] }")
)


@pytest.fixture
def beam(tmp_path):
    path = tmp_path / "beam.toml"
    path.write_text(BEAM.replace('golden = "golden.h5"\n', ""))
    return path


def test_sleeping_parts_are_in_the_static_result(beam):
    result = beam.parent / "result.h5"
    outcome = sandglass("run", beam, "--sleep", "1%", "-o", result, code=0)
    awake = next(line for line in outcome.stdout.splitlines() if line.startswith("awake: "))
    assert 0 < int(awake.split()[1]) < 120 and awake.endswith("of 240 elements")
    assert "static equilibrium (stable): " in outcome.stdout
    with h5py.File(result) as file:
        points = file["mesh/points"][:]
    u = last_displacement(result)
    assert len(u) == 9 * 61
    assert (u[points[:, 2] < 1.0] == 0.0).all()
    assert abs(u).max() > 0.01


def test_a_method_that_computes_no_elements_is_refused():
    words = ("run", "column", "--sleep", "1%", "--method", "linear-condensed")
    sandglass(*words, code=2, message="'linear-condensed'")
