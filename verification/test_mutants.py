"""The mutants of verification/mutants: their patches apply to this tree, and the table has all.

What kills them is the work of `verification/mutants/run.py`, which takes hours.
"""

import subprocess
import threading
from types import SimpleNamespace

import patches
import pytest
import outcomes
import run
from clean_runs import CleanRuns
from command_line import ROOT
from common.errors import InputError
from worker import programs_of

PATCHES = patches.read_patches()


def test_there_are_enough_mutants_each_with_a_number_of_its_own():
    assert len(PATCHES) >= 40
    numbers = [patch.name[:3] for patch in PATCHES]
    assert len(set(numbers)) == len(numbers)
    assert len({patch.mistake for patch in PATCHES}) == len(PATCHES)


@pytest.mark.parametrize("patch", PATCHES, ids=lambda patch: patch.name)
def test_patch_fits_this_tree(patch):
    """A patch that does not must be updated: its mistake is still possible."""
    done = subprocess.run(
        ["git", "apply", "--check", patch.path], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert all((ROOT / name).is_file() for name in patch.files)


def test_table_names_exactly_the_mutants_there_are():
    text = outcomes.TABLE.read_text()
    rows = outcomes.rows_of(text)
    assert list(rows) == [patch.name for patch in PATCHES]
    for patch in PATCHES:
        assert rows[patch.name][1] == patch.mistake
        assert rows[patch.name][2] in ("killed", "equivalent", "survived", "not run"), patch.name


def test_table_survives_being_written_anew(tmp_path, monkeypatch):
    """Without stored results, as in a fresh clone, rows are unchanged."""
    rows = outcomes.rows_of(outcomes.TABLE.read_text())
    table = tmp_path / "RESULTS.md"
    table.write_text(outcomes.TABLE.read_text())
    monkeypatch.setattr(outcomes, "TABLE", table)
    monkeypatch.setattr(outcomes, "STORE", tmp_path / "none")
    outcomes.write_table(PATCHES, "0123456789ab")
    assert outcomes.rows_of(table.read_text()) == rows


def test_every_test_program_is_run():
    """They are read from the build's list, in which a program without a file is not there."""
    programs = {program.name for program in programs_of(ROOT) if not program.is_python}
    assert programs == {file.stem for file in (ROOT / "verification").glob("*_test.cpp")}


def test_names_choose_mutants_and_that_of_the_clean_tree_none():
    assert run.chosen_patches([]) == PATCHES
    assert [patch.name[:3] for patch in run.chosen_patches(["017", "002-c"])] == ["002", "017"]
    assert run.chosen_patches(["clean"]) == []
    assert len(run.chosen_patches(["clean", "017"])) == 1
    with pytest.raises(InputError, match="no mutant begins with '999'"):
        run.chosen_patches(["clean", "999"])


@pytest.mark.parametrize(
    "verdict, code", [("killed", 0), ("equivalent", 0), ("survived", 1), ("broken", 3), (None, 3)]
)
def test_the_table_is_made_of_stored_results_alone(
    tmp_path, monkeypatch, empty_store, verdict, code
):
    monkeypatch.setattr(outcomes, "TABLE", tmp_path / "RESULTS.md")
    monkeypatch.setattr(run, "Worker", None)  # so that none can be made
    patch = PATCHES[0]
    if verdict:
        result = {"patch": patch.digest, "verdict": verdict, "by": "a.test", "seconds": 1.0}
        outcomes.store(patch.name, result | {"revision": "0123456789ab"})
    options = SimpleNamespace(names=[patch.name], table=True)
    assert run.run(options, threading.Event()) == code
    rows = outcomes.rows_of(outcomes.TABLE.read_text())
    assert list(rows) == [patch.name for patch in PATCHES]
    assert rows[patch.name][2] == (verdict or "not run")


def test_no_copy_is_made_when_all_is_finished(tmp_path, monkeypatch, empty_store):
    monkeypatch.setattr(outcomes, "TABLE", tmp_path / "RESULTS.md")
    monkeypatch.setattr(run, "Worker", None)
    tree, patch = run.tree_digest(), PATCHES[0]
    outcomes.store("clean", {"tree": tree, "revision": "", "alarms": [[]], "seconds": {}})
    result = {"patch": patch.digest, "tree": tree, "verdict": "killed", "by": "a.test"}
    outcomes.store(patch.name, result | {"seconds": 1.0, "revision": "0123456789ab"})
    options = SimpleNamespace(names=[patch.name], table=False, clean=1, jobs=2)
    assert run.run(options, threading.Event()) == 0


def test_patch_without_a_sentence_is_refused(tmp_path):
    path = tmp_path / "001-nothing.patch"
    path.write_text("--- a/x\n+++ b/x\n@@ -1 +1 @@\n-a\n+b\n")
    with pytest.raises(ValueError, match="needs a sentence"):
        patches.read_patch(path)


class FakeWorker:
    """A copy of the tree with one program, whose first runs fail as given and later ones pass."""

    def __init__(self, *failures):
        self.failures_left = list(failures)
        self.runs = 0

    def programs(self):
        return [SimpleNamespace(name="all_test")]

    def failures(self, program):
        self.runs += 1
        return (self.failures_left.pop(0) if self.failures_left else []), 1.0


@pytest.fixture
def empty_store(tmp_path, monkeypatch):
    monkeypatch.setattr(outcomes, "STORE", tmp_path / "store")


def clean_runs(wanted, tree="tree"):
    return CleanRuns(wanted, tree, "0123456789ab")


def test_workers_share_the_clean_runs(empty_store):
    runs, workers = clean_runs(7), [FakeWorker(), FakeWorker()]
    threads = [threading.Thread(target=runs.work, args=(worker,)) for worker in workers]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert runs.is_done()
    assert sum(worker.runs for worker in workers) == 7
    assert outcomes.stored(outcomes.CLEAN)["alarms"] == [[]] * 7


def test_clean_runs_of_the_same_tree_count_and_of_another_do_not(empty_store):
    clean_runs(2).work(FakeWorker())
    assert clean_runs(3).missing() == 1
    assert clean_runs(3, "another tree").missing() == 3


def test_a_single_failing_run_is_followed_by_another(empty_store):
    runs, worker = clean_runs(1), FakeWorker(["a"])
    runs.work(worker)
    assert worker.runs == 2
    runs.conclude()  # a false alarm: the second run had none
    assert outcomes.stored(outcomes.CLEAN)["alarms"] == [["a"], []]


def test_what_fails_in_every_run_is_a_broken_tree(empty_store):
    runs = clean_runs(2)
    runs.work(FakeWorker(["a", "b"], ["b"]))
    with pytest.raises(RuntimeError, match="the clean tree fails: b$"):
        runs.conclude()
