"""`ci/tidy.py` remembers what was clean and never a finding: with a clang-tidy of our own."""

import json
import os
import shutil
import subprocess

import pytest
from command_line import ROOT

# Notes each call, and finds what the source says is wrong.
CLANG_TIDY = """#!/bin/bash
if [ "$1" = --version ]; then cat "{tree}/version"; exit; fi
for word in "$@"; do case $word in *.cpp) source=$word; break;; esac; done
echo "$source" >> "{tree}/calls"
if grep -q WRONG "$source"; then echo "$source: error: wrong"; exit 1; fi
"""


class Tree:
    """A folder with a source, its header, and the build that compiles it."""

    def __init__(self, folder):
        self.folder = folder
        for name in ("ci", "bin", "build", "solver"):
            (folder / name).mkdir()
        shutil.copy(ROOT / "ci/tidy.py", folder / "ci")
        self.write("version", "1\n")
        self.write(".clang-tidy", "Checks: one\n")
        self.write("solver/sum.hpp", "int sum(int a, int b);\n")
        self.write("solver/sum.cpp", '#include "sum.hpp"\nint twice(int a) { return sum(a, a); }\n')
        self.write("bin/clang-tidy", CLANG_TIDY.format(tree=folder)).chmod(0o755)
        entries = [self.entry("solver/sum.cpp"), self.entry("solver/late.cpp")]
        self.write("build/compile_commands.json", json.dumps(entries))

    def entry(self, name):
        source = str(self.folder / name)
        command = f"/usr/bin/c++ -I{self.folder}/solver -O3 -o sum.cpp.o -c {source}"
        return {"directory": f"{self.folder}/build", "command": command, "file": source}

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def tidy(self, *sources):
        """(exit status, what was said, how often clang-tidy was called)."""
        (self.folder / "calls").unlink(missing_ok=True)
        done = subprocess.run(
            ["ci/tidy.py", "build", *(sources or ["solver/sum.cpp"])],
            cwd=self.folder,
            env={
                "PATH": f"{self.folder}/bin:{os.defpath}",
                "CCACHE_DIR": str(self.folder / "../remembered"),
            },
            capture_output=True,
            text=True,
        )
        calls = self.folder / "calls"
        called = len(calls.read_text().splitlines()) if calls.exists() else 0
        return done.returncode, done.stdout + done.stderr, called


@pytest.fixture
def tree(tmp_path):
    (tmp_path / "tree").mkdir()
    return Tree(tmp_path / "tree")


def test_what_is_clean_is_not_looked_at_again(tree):
    assert tree.tidy() == (0, "", 1)
    assert tree.tidy() == (0, "", 0)


def test_what_one_clone_has_checked_the_next_need_not(tree, tmp_path):
    assert tree.tidy() == (0, "", 1)
    (tmp_path / "clone").mkdir()
    assert Tree(tmp_path / "clone").tidy() == (0, "", 0)


@pytest.mark.parametrize(
    ("changed", "text"),
    [
        ("solver/sum.hpp", "int sum(int b, int a);\n"),
        ("solver/sum.cpp", '#include "sum.hpp"\nint twice(int a) { return sum(a, 2 * a); }\n'),
        # a comment, which preprocessors drop: it may be NOLINT
        ("solver/sum.cpp", '#include "sum.hpp"\nint twice(int a) { return sum(a, a); }  // once\n'),
        (".clang-tidy", "Checks: two\n"),
        ("version", "2\n"),
    ],
)
def test_any_change_is_looked_at(tree, changed, text):
    assert tree.tidy() == (0, "", 1)
    tree.write(changed, text)
    assert tree.tidy() == (0, "", 1)


def test_a_finding_is_told_each_time(tree):
    tree.write("solver/sum.cpp", "// WRONG\n")
    for _ in range(2):
        status, said, called = tree.tidy()
        assert status == 1
        assert "sum.cpp: error: wrong" in said
        assert called >= 1


def test_one_finding_among_clean_sources_fails(tree):
    tree.write("solver/late.cpp", "int late;\n")
    tree.write("solver/sum.cpp", "// WRONG\n")
    assert tree.tidy("solver/sum.cpp", "solver/late.cpp")[0] == 1
    assert tree.tidy("solver/late.cpp", "solver/sum.cpp")[0] == 1


def test_a_source_that_is_not_compiled_is_told(tree):
    tree.write("solver/stray.cpp", "int stray;\n")
    status, said, called = tree.tidy("solver/stray.cpp")
    assert (status, called) == (1, 0)
    assert said == "ci/tidy.py: build compiles none of: solver/stray.cpp\n"
