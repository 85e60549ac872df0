"""`ci/setup` says what it does and how long it took: with apt-get and dpkg-query of our own."""

import re
import subprocess

import pytest
from command_line import ROOT

TOOLS = ("awk", "bash", "env", "grep", "id", "mktemp", "rm", "sort", "tail")
APT_GET = """#!/bin/bash
echo "apt-get $*" >>"{log}"
case "$1 $2" in
  "install --print-uris")
    echo "Reading package lists..."
    echo "'a://b/c.deb' c.deb 2000000 MD5Sum:0"
    echo "'a://b/d.deb' d.deb 345678 MD5Sum:0" ;;
  "{fails} "*) echo "no such mirror"; exit 100 ;;
esac
"""


@pytest.fixture
def machine(tmp_path):
    """Runs ci/setup where only some packages are installed."""

    def run(*groups, installed="*", debian=True, fails="nothing"):
        tools = tmp_path / "bin"
        tools.mkdir()
        for name in TOOLS:
            (tools / name).symlink_to(f"/usr/bin/{name}")
        status = f'#!/bin/bash\ncase "$3" in {installed}) echo "install ok installed" ;; esac\n'
        scripts = {"dpkg-query": status, "sudo": '#!/bin/bash\nexec "$@"\n'}
        if debian:
            scripts["apt-get"] = APT_GET.format(log=tmp_path / "log", fails=fails)
        for name, text in scripts.items():
            (tools / name).write_text(text)
            (tools / name).chmod(0o755)
        return subprocess.run(
            ["/usr/bin/bash", ROOT / "ci/setup", *groups],
            env={"PATH": str(tools)},
            capture_output=True,
            text=True,
        )

    run.log = tmp_path / "log"
    return run


def test_nothing_is_missing(machine):
    done = machine()
    assert done.returncode == 0 and done.stderr == ""
    said = r"ci/setup: build report test python: 0 of (\d+) packages are missing\n"
    assert int(re.fullmatch(said, done.stdout)[1]) > 20
    assert not machine.log.exists()


def test_what_is_missing_is_named_and_installed(machine):
    done = machine("build", "report", installed="python3* | lib* | git | cmake | make | nlohmann*")
    assert done.returncode == 0 and done.stderr == ""
    first, update, install, fetches, last = done.stdout.splitlines()
    assert re.fullmatch(r"ci/setup: build report: 3 of \d+ packages are missing", first)
    assert update == "ci/setup: apt-get update"
    assert install == "ci/setup: apt-get install ccache g++ ninja-build"
    assert fetches == "ci/setup: fetches 2 files, 2.3 MB"
    assert re.fullmatch(r"ci/setup: done after \d+ s", last)
    asked = machine.log.read_text().splitlines()
    assert asked[0] == "apt-get update" and asked[1].startswith("apt-get install --print-uris")
    assert asked[2:] == ["apt-get install -y --no-install-recommends ccache g++ ninja-build"]


@pytest.mark.parametrize("fails", ["update", "install"])
def test_what_apt_get_says_is_shown_when_it_fails(machine, fails):
    done = machine("python", installed="nothing", fails=fails)
    assert done.returncode == 1
    told = rf"no such mirror\nci/setup: apt-get {fails} failed after \d+ s; nothing else .*\n"
    assert re.fullmatch(told, done.stderr)
    assert "done" not in done.stdout


def test_an_unknown_group(machine):
    done = machine("brench")
    assert done.returncode == 2 and done.stdout == ""
    assert "'brench' is not a group; known: build, report, test, python, bench" in done.stderr


def test_another_system(machine):
    """What to install is listed, and nothing is done."""
    done = machine("bench", debian=False)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.splitlines()[1:] == ["  calculix-ccx", "  libbenchmark-dev"]
