"""Packages are installed and used on a bare Debian where they are built; one version everywhere."""

import re
import sys

import pytest
from command_line import PATIENCE, ROOT, ran
from try_packages import why_not

PACKAGES = ROOT / "build/packages"
TRY = [sys.executable, ROOT / "packaging/try_packages.py"]


def found(pattern, file):
    return re.search(pattern, (ROOT / file).read_text(), re.MULTILINE).groups()


def test_one_version_everywhere():
    """CMakeLists.txt defines it; the newest entry of the changelog has its date, too."""
    (version,) = found(r"^project\(sandglass VERSION (\d+\.\d+\.\d+) ", "CMakeLists.txt")
    newest = found(r"^## Unreleased\n(?:(?!## ).*\n)*## (\S+) - (\d{4}-\d\d-\d\d)$", "CHANGELOG.md")
    assert newest[0] == version
    citation = r"^version: (\S+)\ndate-released: (\S+)$"
    assert found(citation, "CITATION.cff") == newest
    title = found(r"^# Sandglass (\S+)$", f"packaging/release-{version}.md")
    assert title == (version,)
    (wanted,) = found(r"^find_package\(sandglass (\S+) REQUIRED\)", "examples/cpp/CMakeLists.txt")
    assert wanted.split(".")[0] == version.split(".")[0]


def test_the_wheel_has_the_version_of_the_project(tmp_path):
    pytest.importorskip("setuptools")
    (version,) = found(r"^project\(sandglass VERSION (\S+) ", "CMakeLists.txt")
    command = [sys.executable, "setup.py", "--quiet", "--version"]
    done = ran(*command, cwd=ROOT)
    assert done.stdout.split()[-1:] == [version], done.stderr


def test_without_packages_it_says_what_to_do(tmp_path):
    done = ran(*TRY, tmp_path)
    assert done.returncode == 2
    assert re.fullmatch(r"error: .+\n", done.stderr)


@pytest.mark.skipif(why_not(PACKAGES) != "", reason=why_not(PACKAGES))
def test_they_are_installed_and_used_on_a_bare_debian():
    """Takes minutes, mostly for downloads by apt."""
    done = ran(*TRY, timeout=3600 * PATIENCE)
    assert done.returncode == 0, done.stdout + done.stderr
