"""A tiny data set for the tests of the report."""

import pytest
from synthetic import DataSet


@pytest.fixture
def data(tmp_path):
    """A data set like that of `sandglass verify`: one case, four runs, one of them failed."""
    return DataSet(tmp_path)
