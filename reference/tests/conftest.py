"""A case of the reference, with its mesh."""

import numpy as np
import pytest
from blocks import CASE, distorted_block, write_mesh
from loads import JIT_OPTIONS

# Here most forms are evaluated a few times, and compiling them takes most of the time.
JIT_OPTIONS["cffi_extra_compile_args"] = ["-O1", "-g0"]


@pytest.fixture
def folder(tmp_path):
    """A folder with block.toml and its mesh.h5."""
    points, cells, _ = distorted_block(n=2)
    sets = {"bottom": np.flatnonzero(points[:, 2] == 0), "top": np.flatnonzero(points[:, 2] == 1)}
    write_mesh(tmp_path / "mesh.h5", points, cells, sets)
    (tmp_path / "block.toml").write_text(CASE)
    return tmp_path
