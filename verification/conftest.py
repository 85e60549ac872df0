"""What the tests of the command line share."""

import command_line
import pytest


@pytest.fixture
def block(tmp_path):
    """A small case in a folder of its own."""
    file = tmp_path / "block.toml"
    file.write_text(command_line.BLOCK)
    return file
