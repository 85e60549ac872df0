"""A folder of input files for the gate, before and after its first baseline."""

import gate_documents
import pytest


@pytest.fixture
def folder(tmp_path, capsys):
    """Files without a baseline."""
    return gate_documents.Folder(tmp_path, capsys)


@pytest.fixture
def accepted(folder):
    """Files that are the baseline."""
    folder.accept()
    return folder
