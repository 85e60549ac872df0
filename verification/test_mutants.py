"""The mutants of verification/mutants: patches apply and the table is complete; random mistakes.

Whether tests kill them is checked by `verification/mutants/run.py`, which takes hours.
"""

import re
import subprocess
import threading
from types import SimpleNamespace

import outcomes
import patches
import pytest
import run
import worker
from command_line import ROOT, ran
from common.errors import InputError
from plant import Mistake, depend, mistakes_of, plant
from worker import Failure, programs_of

PATCHES = patches.read_patches()


@pytest.mark.parametrize("patch", PATCHES, ids=lambda patch: patch.name)
def test_patch_fits_this_tree(patch):
    """A patch that does not apply must be updated: its mistake is still possible."""
    done = ran("git", "apply", "--check", patch.path, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    assert all((ROOT / name).is_file() for name in patch.files)


def test_every_mutant_is_of_one_kind_and_has_a_row():
    numbers = [patch.name[:3] for patch in PATCHES]
    kinds = re.findall(r"^\|.*\| ([\d, ]+) \|$", (patches.FOLDER / "README.md").read_text(), re.M)
    assert sorted(number for kind in kinds for number in kind.split(", ")) == numbers
    assert len(set(numbers)) == len(numbers) >= 50
    rows = outcomes.rows_of(outcomes.TABLE.read_text())
    assert list(rows) == [patch.name for patch in PATCHES]
    for patch in PATCHES:
        assert rows[patch.name][1] == patch.mistake
        assert rows[patch.name][2] in ("killed", "equivalent", "survived", "not run"), patch.name


def test_every_test_program_is_run():
    """Programs are read from the build's list, which misses one without a file."""
    programs = {program.name for program in programs_of(ROOT) if not program.is_python}
    assert programs == {file.stem for file in (ROOT / "verification").glob("*_test.cpp")}


def test_names_choose_mutants():
    assert run.chosen_patches([]) == PATCHES
    assert [patch.name[:3] for patch in run.chosen_patches(["017", "002-c"])] == ["002", "017"]
    with pytest.raises(InputError, match="no mutant begins with '999'"):
        run.chosen_patches(["999", "017"])


def test_patch_without_a_sentence_is_refused(tmp_path):
    path = tmp_path / "001-nothing.patch"
    path.write_text("--- a/x\n+++ b/x\n@@ -1 +1 @@\n-a\n+b\n")
    with pytest.raises(ValueError, match="needs a sentence"):
        patches.read_patch(path)


class FakeWorker:
    """In place of a copy of the tree, with a given outcome."""

    outcome = None

    def __init__(self, *_):
        assert self.outcome != "none is made"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def first_failure(self, patch, _):
        return self.outcome and Failure(self.outcome, "a.test", None)


@pytest.fixture
def call(tmp_path, monkeypatch):
    """Runs the command line with workers of a given outcome and a store and table of its own."""
    (tmp_path / "RESULTS.md").write_text(outcomes.TABLE.read_text())
    monkeypatch.setattr(outcomes, "TABLE", tmp_path / "RESULTS.md")
    monkeypatch.setattr(outcomes, "STORE", tmp_path / "store")
    monkeypatch.setattr(run, "Worker", FakeWorker)

    def called(outcome, **given):
        monkeypatch.setattr(FakeWorker, "outcome", outcome)
        options = {"names": ["017"], "table": False, "jobs": 1, "timeout": 9.0, "random": 0}
        options |= {"files": ["*"], "tests": []}
        code = run.run(SimpleNamespace(**options | given), threading.Event())
        rows = outcomes.rows_of(outcomes.TABLE.read_text())
        return code, next(row for name, row in rows.items() if name.startswith("017"))[2]

    return called


@pytest.mark.parametrize(
    "outcome, code, verdict",
    [
        ("killed", 0, "killed"),
        ("timeout", 0, "killed"),
        (None, 1, "survived"),
        ("broken", 3, "broken"),
        ("false alarm", 3, "false alarm"),
    ],
)
def test_verdicts_are_stored_and_written(call, outcome, code, verdict):
    before = outcomes.rows_of(outcomes.TABLE.read_text())
    assert call(outcome) == (code, verdict)
    again = outcome if code == 3 else "none is made"  # mutants with a verdict are finished
    assert call(again) == call("none is made", table=True) == (code, verdict)
    after = outcomes.rows_of(outcomes.TABLE.read_text())
    assert [name for name in before if before[name] != after[name]] == [
        run.chosen_patches(["017"])[0].name
    ]


@pytest.mark.parametrize(
    "line, kind, mistakes",
    [
        ("  a += b * c[i];", "operator", ["a -= b * c[i];", "a += b / c[i];"]),
        ("  if (a < b && c)", "operator", ["if (a <= b && c)", "if (a < b || c)"]),
        ("  f(0.5);", "number", ["f(1.0);", "f(1.5);", "f(-0.5);"]),
        ("  g(x[i]);", "index", ["g(x[0]);"]),
        ("  g(x[i][2]);", "order", ["g(x[2][i]);"]),
        ("  h(a, b[0]);", "order", ["h(b[0], a);"]),
        ("  return -x;", "sign", ["return x;"]),
        ('  const T y = q("a + 1", z);', "sign", ['const T y = -(q("a + 1", z));']),
        ('  fail("a + 1");  // 2 * 3', "number", []),
        ("#include <a>  // 1", "number", []),
        ("int* p, const A<B>& q", "operator", []),
    ],
)
def test_mistakes_of_a_line(line, kind, mistakes):
    assert [text.strip() for one, text in mistakes_of(line) if one == kind] == mistakes


def test_only_statements_that_depend_on_each_other_are_swapped():
    assert depend("  a = b;", "  c = a;") and depend("  c = a;", "  a = b;")
    assert depend("  f(a);", "  c = a;")  # f may change it
    assert not depend("  a = c;", "  b = c;")
    assert not depend("  const double a = c;", "  const double b = c;")


def commit(folder, files):
    """Commits files, {path: text}, to the repository of a folder."""

    def git(*words):
        own = ["-c", "user.name=n", "-c", "user.email=e", "-c", "commit.gpgsign=false"]
        subprocess.run(["git", "-C", folder, *own, *words], check=True, capture_output=True)

    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    git("init", "-q")
    git("add", "-A")
    git("commit", "-qm", "c")


@pytest.fixture
def tree(tmp_path):
    """A repository whose last commit adds three lines."""
    for text in ("int old = 1 + 2;\n", "int old = 1 + 2;\n  a = b;\n  c = d * a;\n// 3 + 4\n"):
        commit(tmp_path, {"solver/a.cpp": text, "other.cpp": text})
    return tmp_path


def test_random_mistakes_are_of_the_change_and_apply(tree):
    planted = plant(tree, "HEAD~1", 99, 7)
    assert planted == plant(tree, "HEAD~1", 99, 7)
    assert list(plant(tree, "HEAD~1", 1, 7)) == list(planted)[:1]
    assert {mistake.line for mistake in planted} == {2, 3}
    assert plant(tree, "HEAD~1", 99, 7, ["solver/*.cpp"]) == planted
    assert not plant(tree, "HEAD~1", 99, 7, ["solver/*.hpp", "suite/*"])
    swapped = Mistake(
        "solver/a.cpp", 2, "order", ("  a = b;", "  c = d * a;"), ("  c = d * a;", "  a = b;")
    )
    assert swapped in planted
    for mistake, text in planted.items():
        (tree / "a.patch").write_text(mistake.patch(text))
        subprocess.run(["git", "-C", tree, "apply", "--check", "a.patch"], check=True)


def test_random_mistakes_are_reported(tree, call, monkeypatch, capsys):
    monkeypatch.setattr(run, "ROOT", tree)
    given = {"random": 2, "seed": 7, "since": "HEAD~1"}
    assert call("killed", **given)[0] == 0
    text = capsys.readouterr().out
    assert "noticed by a.test\n    - " in text and "noticed: 2 of 2 that compile, 100 %" in text
    assert call(None, **given)[0] == 1
    assert "noticed: 0 of 2 that compile, 0 %" in capsys.readouterr().out
    for wrong, said in (({"since": "HEAD"}, "no lines of C"), ({"files": ["a"]}, "no lines of C")):
        with pytest.raises(InputError, match=said):
            call(None, **given | wrong)
    monkeypatch.setattr(run, "programs_of", lambda _: [SimpleNamespace(name="load_test")])
    with pytest.raises(InputError, match="--tests lod_test: allowed are load_test"):
        call(None, **given | {"tests": ["lod_test"]})


SMALL_PROJECT = {
    "CMakePresets.json": """{"version": 6, "configurePresets": [
        {"name": "developer", "generator": "Ninja"}, {"name": "quick", "generator": "Ninja"}]}""",
    "CMakeLists.txt": """cmake_minimum_required(VERSION 3.25)
project(small LANGUAGES CXX)
function(add_tests name library)
  foreach(test ${ARGN})
    add_executable(${test} ${test}.cpp)
    target_link_libraries(${test} ${library})
  endforeach()
endfunction()
add_subdirectory(solver)
add_subdirectory(verification)
""",
    "solver/CMakeLists.txt": "add_library(a a.cpp)\n",
    "solver/a.hpp": "inline int two() { return 2; }\n",
    "solver/a.cpp": '#include "a.hpp"\nint four() { return 2 * two(); }\n',
    "verification/CMakeLists.txt": "add_tests(all a\n  calm_test\n  small_test)\n",
    "verification/calm_test.cpp": "int main() {}\n",
    "verification/small_test.cpp": r"""#include <cstdio>
int four();
int main() {
  if (four() == 4) return 0;
  std::puts("[  FAILED  ] Small.four (0 ms)");
  return 1;
}
""",
}


@pytest.mark.parametrize("file", ["solver/a.hpp", "solver/a.cpp"])
def test_mutants_are_built_and_leave_nothing_behind(tmp_path, monkeypatch, file):
    """Each outcome twice: what a mutant was built to would be in the next one."""
    commit(tmp_path, SMALL_PROJECT)
    monkeypatch.setattr(worker, "ROOT", tmp_path)
    text = SMALL_PROJECT[file]
    mistakes = {"killed": ("return ", "return 1 + "), "broken": ("int", "in"), None: ("{ ", "{  ")}
    for_sources = file.endswith(".cpp")
    with worker.Worker(
        "HEAD", threading.Event(), 1, ["calm_test", "small_test"], for_sources
    ) as copy:
        for kind, (right, wrong) in [*mistakes.items(), *mistakes.items()]:
            line = text.splitlines()[-1]
            mistake = Mistake(
                file, text.count("\n"), "word", (line,), (line.replace(right, wrong, 1),)
            )
            path = tmp_path / "a.patch"
            path.write_text(mistake.patch(text))
            failure = copy.first_failure(patches.read_patch(path), 60.0)
            assert (failure.kind if failure else None) == kind
            assert kind != "killed" or failure.by == "Small.four"
