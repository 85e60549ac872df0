"""Fixtures that the tests of several folders share."""

import logging

import command_line
import pytest

logging.disable(logging.INFO)  # FFCx reports every compiler call otherwise


@pytest.fixture
def block(tmp_path):
    """A small case in its own folder."""
    file = tmp_path / "block.toml"
    file.write_text(command_line.BLOCK)
    return file
