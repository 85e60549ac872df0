"""Makes exchange/ importable, and what the tests of the solver's command line share."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "verification")]

import command_line  # noqa: E402  (the path above must come first)


@pytest.fixture
def block(tmp_path):
    """A small case in a folder of its own."""
    file = tmp_path / "block.toml"
    file.write_text(command_line.BLOCK)
    return file
