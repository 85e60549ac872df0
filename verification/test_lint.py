"""Files that clang-tidy checks after a change, and arguments of the scripts that check changes."""

from pathlib import Path

import affected
import pytest
import yaml
from command_line import ROOT, ran

FILES = {
    ".clang-tidy": "Checks: '-*'\n",
    ".gitignore": "build/\n",
    "ci/tidy.py": "",
    "solver/base/deep.hpp": "int deep();\n",
    "solver/base/near.hpp": '#include "base/deep.hpp"\n',
    "solver/base/other.hpp": "int other();\n",
    "solver/base/lone.hpp": "int lone();\n",
    "solver/base/deep.cpp": '#include <string>\n#include "base/deep.hpp"\n',
    "solver/base/both.cpp": '#include "base/near.hpp"\n#include "base/other.hpp"\n',
    "app/main.cpp": '#include "app/words.hpp"\n#include "base/near.hpp"\n',
    "app/words.hpp": '#include "list.hpp"\n',
    "app/list.hpp": "int list();\n",
}
SOURCES = [name for name in FILES if name.endswith(".cpp")]


class Clone:
    """A repository in which `ci/lint all` found nothing."""

    def __init__(self, root):
        self.root = root
        self.git("init", "-q")
        for name in FILES:
            self.write(name, FILES[name])
        self.commit()
        self.write(".ci/linted", self.git("rev-parse", "HEAD"))
        self.commit()

    def git(self, *words):
        own = ["-c", "user.name=A", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
        done = ran("git", *own, *words, cwd=self.root, check=True)
        return done.stdout

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)

    def touch(self, *names):
        for name in names:
            self.write(name, (self.root / name).read_text() + "// changed\n")

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "a change")

    def chosen(self):
        """(sources, why)."""
        return affected.chosen(self.root, SOURCES)


@pytest.fixture
def clone(tmp_path):
    return Clone(tmp_path)


@pytest.mark.parametrize("committed", [True, False])
@pytest.mark.parametrize(
    "changed, looked_at",
    [
        ([], []),
        (["solver/base/both.cpp"], ["solver/base/both.cpp"]),
        # A changed source that includes it shows findings in a header, through others too.
        (["app/list.hpp"], ["app/main.cpp"]),
        (["app/main.cpp", "solver/base/deep.hpp"], ["app/main.cpp"]),
        # One source for two headers, although others come first in the list.
        (["solver/base/deep.hpp", "solver/base/other.hpp"], ["solver/base/both.cpp"]),
        (
            ["app/words.hpp", "solver/base/other.hpp"],
            ["solver/base/both.cpp", "app/main.cpp"],
        ),
        (["solver/base/lone.hpp", "solver/base/near.hpp"], ["solver/base/both.cpp"]),
    ],
)
def test_changed_sources_and_one_that_includes_each_changed_header(
    clone, changed, looked_at, committed
):
    clone.touch(*changed)
    if committed and changed:
        clone.commit()
    assert clone.chosen()[0] == looked_at


def test_new_files_are_changes_and_deleted_ones_are_not_looked_at(clone):
    clone.write("solver/base/new.hpp", "int added();\n")
    clone.write("solver/base/deep.cpp", '#include "base/new.hpp"\n')
    (clone.root / "solver/base/lone.hpp").unlink()
    assert clone.chosen()[0] == ["solver/base/deep.cpp"]


@pytest.mark.parametrize("changed", [".clang-tidy", "ci/tidy.py"])
def test_changed_checks_require_a_run_on_all_sources(clone, changed):
    clone.touch(changed)
    with pytest.raises(SystemExit, match=f"{changed} changed since .*: run `ci/lint all`"):
        clone.chosen()


def test_all_sources_where_the_revision_is_unknown(clone, tmp_path):
    shallow = tmp_path / "shallow"
    clone.git("clone", "-q", "--depth=1", f"file://{clone.root}", str(shallow))
    sources, why = affected.chosen(shallow, SOURCES)
    assert sources == SOURCES and "is not in this clone" in why


def test_the_revision_in_ci_linted_is_of_this_history():
    """Otherwise `ci/lint` checks everything on each machine that has checked nothing before."""
    if not (ROOT / ".git").exists():
        pytest.skip("no clone")

    def git(*words):
        return ran("git", *words, cwd=ROOT)

    if git("rev-parse", "--is-shallow-repository").stdout != "false\n":
        pytest.skip("a shallow clone")
    revision = (ROOT / ".ci/linted").read_text().strip()
    assert git("merge-base", "--is-ancestor", revision, "HEAD").returncode == 0


@pytest.mark.parametrize("script", ["lint", "test"])
def test_a_word_that_a_script_does_not_know_is_refused_before_anything_is_done(script):
    done = ran("bash", f"ci/{script}", "al", cwd=ROOT)
    assert done.returncode == 2 and "'al' is not known; allowed: nothing, " in done.stderr
    assert done.stdout == ""


def test_a_change_is_tested_first_and_the_workflow_runs_what_is_there():
    def scripts(lines):
        return [line.split()[1:] for line in lines if line.startswith("bash ")]

    run = scripts(Path(ROOT / ".ci/run").read_text().splitlines())
    assert run == [
        ["ci/setup", "build"],
        ["ci/test"],
        ["ci/verify", "accuracy"],
        ["ci/lint"],
        ["ci/docs-site"],
    ]
    jobs = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text())["jobs"]
    steps = {name: scripts(s.get("run", "") for s in job["steps"]) for name, job in jobs.items()}
    assert steps["avx2"] == [["ci/test", "avx2"]]
    assert ["ci/lint", "all"] in steps["check"] and ["ci/test"] in steps["check"]
    assert all((ROOT / words[0]).is_file() for some in steps.values() for words in some)
