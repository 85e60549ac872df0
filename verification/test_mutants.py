"""The mutants of verification/mutants: their patches fit this tree, and the table knows them all.

What kills them is the work of `ci/mutants`, which takes hours.
"""

import subprocess

import patches
import pytest
import results
from command_line import ROOT

PATCHES = patches.read_patches()


def test_there_are_enough_mutants_each_with_a_number_of_its_own():
    assert len(PATCHES) >= 40
    numbers = [patch.name[:3] for patch in PATCHES]
    assert len(set(numbers)) == len(numbers)
    assert len({patch.mistake for patch in PATCHES}) == len(PATCHES)


@pytest.mark.parametrize("patch", PATCHES, ids=lambda patch: patch.name)
def test_patch_fits_this_tree(patch):
    """A patch that does not is to be made anew: its mistake can still be made."""
    done = subprocess.run(
        ["git", "apply", "--check", patch.path], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert all((ROOT / name).is_file() for name in patch.files)


def test_table_names_exactly_the_mutants_there_are():
    text = results.TABLE.read_text()
    rows = results.rows_of(text)
    assert list(rows) == [patch.name for patch in PATCHES]
    for patch in PATCHES:
        assert rows[patch.name][1] == patch.mistake
        assert rows[patch.name][2] in ("killed", "equivalent", "survived", "not run"), patch.name


def test_table_survives_being_written_anew(tmp_path, monkeypatch):
    """Without stored results, as in a fresh clone, rows stay what they were."""
    rows = results.rows_of(results.TABLE.read_text())
    table = tmp_path / "RESULTS.md"
    table.write_text(results.TABLE.read_text())
    monkeypatch.setattr(results, "TABLE", table)
    monkeypatch.setattr(results, "STORE", tmp_path / "none")
    results.write_table(PATCHES, "0123456789ab")
    assert results.rows_of(table.read_text()) == rows


def test_patch_without_a_sentence_is_refused(tmp_path):
    path = tmp_path / "001-nothing.patch"
    path.write_text("--- a/x\n+++ b/x\n@@ -1 +1 @@\n-a\n+b\n")
    with pytest.raises(ValueError, match="needs a sentence"):
        patches.read_patch(path)
