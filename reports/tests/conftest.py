"""Makes the report's package importable and offers a tiny data set."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent))

from synthetic import DataSet  # noqa: E402


@pytest.fixture
def data(tmp_path):
    """A data set as `sandglass verify` would leave it: one case, four runs, one of them failed."""
    return DataSet(tmp_path)
