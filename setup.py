"""The wheel: CMake builds package and program, as for the Debian package; setuptools packs them.

Beside the module it has the program and the cases, below bin/ and share/ of the environment.
"""

import os
import platform
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
PRESET = "portable"
BUILD = ROOT / "build" / PRESET


def cmake(*arguments):
    subprocess.run(["cmake", *map(str, arguments)], cwd=ROOT, check=True)


def version():
    """The project's version, which is stated only in CMakeLists.txt."""
    text = (ROOT / "CMakeLists.txt").read_text()
    return re.search(r"^project\(sandglass VERSION (\S+) ", text, re.MULTILINE)[1]


class Build(build_ext):
    """Builds with CMake, and adds the files beside the module to setuptools' list."""

    def run(self):
        options = [f"-DPython_EXECUTABLE={sys.executable}", "-DSANDGLASS_PYTHON=ON"]
        if platform.machine() != "x86_64":  # other processors have no common instruction set here
            options.append("-DSANDGLASS_ARCH=native")
        try:
            import pybind11

            options.append(f"-Dpybind11_DIR={pybind11.get_cmake_dir()}")
        except ImportError:
            pass  # CMake finds the system's, or reports what is missing
        cmake("--preset", PRESET, *options)
        targets = ["sandglass_cli", "sandglass_python"]
        cmake("--build", "--preset", PRESET, "--target", *targets, "--", "--quiet")
        (module,) = self.extensions
        self.mkpath(str(Path(self.get_ext_fullpath(module.name)).parent))
        built = BUILD / "python" / os.path.basename(self.get_ext_filename(module.name))
        self.copy_file(str(built), self.get_ext_fullpath(module.name))
        # The package as the build left it, with the stubs that the build wrote.
        package = Path(self.get_ext_fullpath(module.name)).parent / "sandglass"
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(BUILD / "python/sandglass", package, ignore=ignored, dirs_exist_ok=True)
        stage = Path(self.build_temp).resolve() / "prefix"
        shutil.rmtree(stage, ignore_errors=True)
        options = ["--component", "runtime", "--strip"]
        cmake("--install", BUILD, "--prefix", stage, *options)
        files = {}
        for file in sorted(stage.rglob("*")):
            if file.is_file():
                folder = str(file.parent.relative_to(stage))
                files.setdefault(folder, []).append(str(file))
        self.distribution.data_files = list(files.items())


setup(
    version=version(),
    packages=[],
    ext_modules=[Extension("_sandglass", [])],
    cmdclass={"build_ext": Build},
)
