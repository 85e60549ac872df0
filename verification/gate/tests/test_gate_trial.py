"""The trial can be repeated: its patches apply to the tree, and its table has a place."""

import subprocess

import pytest
from gate import trial


@pytest.mark.parametrize(
    "patch", sorted((trial.HERE / "plants").glob("*.patch")), ids=lambda p: p.stem
)
def test_plants_of_the_trial_fit_this_tree(patch):
    done = subprocess.run(
        ["git", "apply", "--check", patch], cwd=trial.ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


def test_readme_has_a_place_for_the_table():
    text = (trial.HERE / "README.md").read_text()
    assert all(text.count(mark) == 1 for mark in trial.MARKS)
