"""A folder of files that the gate is called with, before and after its first baseline."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent))

import gate_documents  # noqa: E402 (the path must be set first)


@pytest.fixture
def folder(tmp_path, capsys):
    """Files without a baseline."""
    return gate_documents.Folder(tmp_path, capsys)


@pytest.fixture
def accepted(folder):
    """Files that are the baseline."""
    folder.accept()
    return folder
