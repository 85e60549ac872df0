"""Installs the Debian package on a bare Debian 12 and uses it as a person would; then the wheel.

The system is a minimal one in a folder, entered by chroot; what is mounted there is mounted for one
command alone. Needs root, debootstrap and unshare, and the network as apt of this machine sees it.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "verification")]

import readme  # noqa: E402

from common.command import exit_code  # noqa: E402
from common.errors import ComputationError, InputError  # noqa: E402

SUITE = "bookworm"
HOME = "/root/try"
PACKAGES = {"deb": "sandglass_*.deb", "whl": "sandglass-*.whl"}
# Enters the system $0 for the command $1: its view of this machine leads to the packages.
ENTER = f"""
set -e
for shared in /etc/apt /etc/ssl/certs /etc/resolv.conf /etc/hosts; do
  mount -o bind,ro "$shared" "$0$shared"
done
mount -t proc proc "$0/proc"
mount --rbind /dev "$0/dev"
exec chroot "$0" env -i HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \\
  PATH=/usr/sbin:/usr/bin:/sbin:/bin bash -c "cd {HOME} && $1"
"""
LATER = """cmake_minimum_required(VERSION 3.25)
project(later LANGUAGES CXX)
find_package(sandglass {} REQUIRED)
"""


class BareDebian:
    """A minimal Debian 12 in a folder, made if missing."""

    def __init__(self, folder):
        self.folder = folder
        if not (folder / "usr/bin/apt-get").exists():
            start = time.monotonic()
            command = ["debootstrap", "--variant=minbase", "--include=ca-certificates"]
            done = _run([*command, SUITE, folder, *_mirror()])
            if done.returncode != 0:
                raise ComputationError(f"{folder}: debootstrap failed: {_end(done)}")
            print(f"{time.monotonic() - start:5.0f} s  a bare Debian 12")
        for name in ("resolv.conf", "hosts"):
            (folder / "etc" / name).touch()
        self.home = folder / HOME[1:]
        shutil.rmtree(self.home, ignore_errors=True)
        self.home.mkdir()

    def run(self, command, says="", code=0):
        """Runs a command and checks its exit code and output. Raises ComputationError."""
        start = time.monotonic()
        alone = ["unshare", "--mount", "--pid", "--fork", "--kill-child"]
        done = _run([*alone, "bash", "-c", ENTER, self.folder, command])
        if done.returncode != code or says not in done.stdout + done.stderr:
            expected = f"{code} and '{says}'" if says else code
            raise ComputationError(
                f"{command}: ended with {done.returncode}, not {expected}: {_end(done)}"
            )
        print(f"{time.monotonic() - start:5.0f} s  {command}", flush=True)


def _run(command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True)


def _end(done):
    return "\n".join((done.stdout + done.stderr).splitlines()[-20:])


def _mirror():
    """The package source of this machine's apt, if known."""
    sources = ["/etc/apt/sources.list.d/debian.sources", "/etc/apt/sources.list"]
    texts = [Path(source).read_text() for source in sources if os.path.exists(source)]
    return re.findall(r"^(?:URIs: *|deb +(?:\[.*?\] +)?)(\S+)", "\n".join(texts), re.M)[:1]


def first_case():
    """Name and text of the first case in README.md, and the command that runs it."""
    parts = readme.parts((ROOT / "README.md").read_text())
    (case, *_) = [part for part in parts if part.kind == "file" and "[case]" in part.text]
    commands = [part.text for part in parts if f"sandglass run {case.path}" in part.text]
    return case.path, case.text, commands[0].replace("build/release/", "")


def use(system, case, run, module_in):
    """Runs the README's first case, and the module without PYTHONPATH; both know their folders."""
    version = re.search(r"VERSION (\S+) ", (ROOT / "CMakeLists.txt").read_text())[1]
    python = "/usr/bin/python3" if module_in.startswith("/usr") else "python3"
    activate = "" if module_in.startswith("/usr") else ". venv/bin/activate && "
    system.run(f"{activate}sandglass --version", says=f"sandglass {version} ")
    system.run(f"{activate}sandglass cases", says="ellipsoid-indentation")
    system.run(f"{activate}{run}", says="static equilibrium")
    system.run(f"{activate}sandglass choose {case} --tolerance 5% -o chosen.toml")
    system.run(f"{activate}sandglass run chosen.toml -o chosen.h5", says="static equilibrium")
    # Scripts next to the program or the module read meshes of other programs.
    system.run(f"{activate}sandglass mesh hook.toml -o hook.h5")
    script = "import sandglass; sandglass.Simulation('hook.toml').settle(); "
    script += "print(sandglass.__file__, sandglass.__version__)"
    system.run(f'{activate}{python} -c "{script}"', says=f"{module_in}/sandglass/")
    done = "1.00 s: largest displacement"
    system.run(f"{activate}{python} example.py {case} moved 0.03 0 0", says=done)
    system.run(f"{activate}sandglass run missing.toml", says="missing.toml", code=2)


def try_packages(system, deb, wheel):
    """Raises ComputationError where a command does not do what it should."""
    case, text, run = first_case()
    (system.home / case).write_text(text)
    for file in ("python/example.py", "exchange/example/hook.toml", "exchange/example/hook.msh"):
        shutil.copy(ROOT / file, system.home)
    shutil.copytree(ROOT / "examples/cpp", system.home / "cpp")
    for package in (deb, wheel):
        shutil.copy(package, system.home)

    system.run("apt-get update")
    system.run(f"apt-get install -y --reinstall ./{deb.name}")
    use(system, case, run, "/usr/lib/python3/dist-packages")
    system.run(
        "ls /usr/share/man/man1/sandglass.1 /usr/share/bash-completion/completions/sandglass"
    )

    system.run("apt-get install -y --no-install-recommends cmake g++ make")
    system.run("cmake -S cpp -B example && cmake --build example")
    system.run(f"example/step_a_scene {case} moved 0.03 0 0", says="1.000 s, force")
    system.run("example/step_a_scene hook.toml tip 0 0 -0.001", says="1.000 s, force")
    for version in ("0.9", "2.0"):
        (system.home / "later").mkdir(exist_ok=True)
        (system.home / "later/CMakeLists.txt").write_text(LATER.format(version))
        system.run("cmake -S later -B later/build", says=f'version "{version}"', code=1)

    # The wheel must not need the package, only the libraries that it contains.
    system.run("apt-get remove -y sandglass")
    system.run("ls /usr/bin/sandglass /usr/share/sandglass", says="cannot access", code=2)
    system.run("apt-get install -y --no-install-recommends python3-venv")
    system.run("python3 -m venv --system-site-packages venv")
    system.run(f"venv/bin/pip install --no-index ./{wheel.name}")
    use(system, case, run, f"{HOME}/venv/lib/python3.11/site-packages")
    system.run(
        "venv/bin/pip uninstall -y sandglass && ! ls venv/bin/sandglass venv/share/sandglass"
    )


def why_not(folder):
    """The reason why packages in a folder cannot be tried on this machine; empty if they can."""
    if os.geteuid() != 0:
        return "making a bare Debian needs root"
    for tool in ("debootstrap", "unshare"):
        if shutil.which(tool) is None:
            return f"{tool} is not installed"
    if _run(["unshare", "--mount", "--pid", "--fork", "true"]).returncode != 0:
        return "nothing can be mounted here: unshare --mount --pid is not permitted"
    absent = [pattern for pattern in PACKAGES.values() if not list(folder.glob(pattern))]
    return f"{folder}: has no {' and no '.join(absent)}; make them by ci/package" if absent else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "build/packages")
    parser.add_argument("--system", type=Path, help="keep the system in this folder, and use it")
    arguments = parser.parse_args()
    if reason := why_not(arguments.folder):
        raise InputError(reason)
    newest = [
        max(arguments.folder.glob(pattern), key=os.path.getmtime) for pattern in PACKAGES.values()
    ]
    with tempfile.TemporaryDirectory() as folder:
        try_packages(BareDebian(arguments.system or Path(folder) / "debian"), *newest)


if __name__ == "__main__":
    sys.exit(exit_code(main))
