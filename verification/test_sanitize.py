"""`ci/sanitize` fails where a part fails: with ctest and a build of our own."""

import shutil
import subprocess

import pytest
from command_line import ROOT


@pytest.fixture
def sanitize(tmp_path):
    """Runs ci/sanitize in a tree whose Python tests pass, with a ctest that ends as told."""

    def run(ctest):
        for folder in ("ci", "bin", "verification"):
            (tmp_path / folder).mkdir()
        shutil.copy(ROOT / "ci/sanitize", tmp_path / "ci")
        for script in ("ci/setup", "ci/build", "bin/ctest"):
            (tmp_path / script).write_text(
                f"#!/bin/bash\n{ctest if 'ctest' in script else 'exit 0'}\n"
            )
            (tmp_path / script).chmod(0o755)
        (tmp_path / "verification/test_it.py").write_text("def test_it():\n    pass\n")
        return subprocess.run(
            ["/usr/bin/bash", "ci/sanitize", "address"],
            cwd=tmp_path,
            env={"PATH": f"{tmp_path}/bin:/usr/bin:/bin"},
            capture_output=True,
            text=True,
        )

    return run


def test_says_that_all_is_clean(sanitize):
    done = sanitize("exit 0")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "ci/sanitize: address clean after" in done.stdout


def test_a_failed_test_fails_it_though_later_ones_pass(sanitize):
    done = sanitize("exit 1")
    assert done.returncode == 1
    assert "clean" not in done.stdout
