"""Fixtures that tests of this folder share."""

import card
import pytest


@pytest.fixture(scope="module")
def card_folder(tmp_path_factory):
    """The kernels and answers that the script for cards reads."""
    made = tmp_path_factory.mktemp("card")
    assert card.main([str(made), "--write"]) == 0
    return made
