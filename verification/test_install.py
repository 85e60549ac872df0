"""The installed library in other projects: found, built without flags, same steps as the program.

Installs from the build folder of the program under test.
"""

import json
import os
import pathlib
import platform
import shutil

import h5py
import numpy as np
import pytest
from command_line import BARE, BINARY, PATIENCE, ROOT, dynamic, ran, sandglass

BUILD = pathlib.Path(BINARY).resolve().parent
DYNAMIC = dynamic(BARE, duration=1.0, time_step=1e-3, frames=10)


def run(*command, **options):
    done = ran(*command, timeout=300 * PATIENCE, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    """A folder with a complete installation."""
    folder = tmp_path_factory.mktemp("prefix")
    run("cmake", "--install", BUILD, "--prefix", folder)
    return folder


def built(source, folder, *options):
    run("cmake", "-S", source, "-B", folder, "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *options)
    run("cmake", "--build", folder)
    return (folder / "compile_commands.json").read_text()


@pytest.mark.parametrize("found", ["installed", "in the build folder"])
def test_the_example_steps_as_the_program(found, prefix, tmp_path):
    """Limit: half a unit in the last place of 0.02 m, accumulated by two sums over 1000 steps."""
    case = tmp_path / "block.toml"
    case.write_text(DYNAMIC)
    where = {"installed": f"-DCMAKE_PREFIX_PATH={prefix}"}.get(found, f"-Dsandglass_DIR={BUILD}")
    commands = built(ROOT / "examples" / "cpp", tmp_path / "build", where)
    assert "-march" not in commands and "fmt" not in commands and "-Werror" not in commands

    out = run(tmp_path / "build" / "step_a_scene", case, "head", 0.02, 0.0, 0.01)
    nodes = [line.split() for line in out.splitlines() if line.startswith("  ")]
    assert sandglass("run", case, "-o", tmp_path / "result.h5").returncode == 0
    with h5py.File(tmp_path / "result.h5") as result:
        n_nodes = len(result["mesh/points"])
        shown = range(0, n_nodes, 10)
        expected = [
            result[f"frames/{n:04d}/displacement"][node] for n in range(1, 11) for node in shown
        ]
    assert np.abs(np.array(nodes, dtype=float) - expected).max() < 1000 * 1000 * 1.8e-18
    assert np.abs(expected).max() >= 0.02


AROUND = """
cmake_minimum_required(VERSION 3.25)
project(around LANGUAGES CXX)
{way}
add_library(own OBJECT own.cpp)
target_link_libraries(own PRIVATE sandglass::sandglass)
"""
OWN = """
#include <sandglass/batch.hpp>
#if __has_include("math/pack.hpp") || __has_include("base/names.hpp")
#error more than the public headers
#endif
double time(const sandglass::Simulation<double>& body) { return body.time(); }
"""


@pytest.mark.parametrize(
    "way", ["find_package(sandglass REQUIRED)", f"add_subdirectory({ROOT} inner)"]
)
def test_other_projects_see_the_public_headers_and_get_the_library_alone(way, tmp_path):
    (tmp_path / "CMakeLists.txt").write_text(AROUND.format(way=way))
    (tmp_path / "own.cpp").write_text(OWN)
    build = tmp_path / "build"
    options = ["-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", f"-Dsandglass_DIR={BUILD}"]
    run("cmake", "-G", "Ninja", "-S", tmp_path, "-B", build, *options)
    run("cmake", "--build", build, "--target", "own")
    commands = {
        c["file"]: c["command"] for c in json.loads((build / "compile_commands.json").read_text())
    }
    assert "-march" not in commands.pop(str(tmp_path / "own.cpp"))
    sources = [pathlib.Path(file) for file in commands if not file.startswith(str(build))]
    assert {file.relative_to(ROOT).parts[0] for file in sources} <= {"solver"}
    assert "Python_EXECUTABLE" not in (build / "CMakeCache.txt").read_text()


def test_the_header_stands_alone_and_brings_no_kernel(prefix, tmp_path):
    """Other flags would give other packs of the same name; a program must not contain any."""
    (tmp_path / "only.cpp").write_text(
        "#include <sandglass/simulation.hpp>\n"
        "double time(const char* file) { return sandglass::Simulation<float>(file).time(); }\n"
    )
    flags = ["-std=c++20", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]
    run("c++", *flags, "-isystem", prefix / "include", "-c", "only.cpp", cwd=tmp_path)
    defined = run("nm", "--demangle", "--defined-only", tmp_path / "only.o")
    own = [line for line in defined.splitlines() if "sandglass::" in line]
    assert all("Simulation" in line for line in own), own


def test_only_public_headers_are_installed(prefix):
    """Kernels need the flags of the library; with others, packs of the same name would differ."""
    headers = {str(f.relative_to(prefix / "include")) for f in (prefix / "include").rglob("*.hpp")}
    public = {"sandglass/simulation.hpp", "sandglass/batch.hpp", "sandglass/base/error.hpp"}
    assert headers == public


def test_the_installed_program_has_its_cases(prefix, tmp_path):
    """Even where neither the source nor a folder `cases` is available."""
    environment = {name: value for name, value in os.environ.items() if name != "SANDGLASS_CASES"}
    moved = shutil.copytree(prefix, tmp_path / "elsewhere")
    listed = run(moved / "bin" / "sandglass", "cases", cwd=tmp_path, env=environment)
    assert sorted(line.split()[0] for line in listed.splitlines() if line[:1].isalpha())
    strings = (moved / "share" / "sandglass" / "cases").glob("*.toml")
    names = {file.stem for file in strings}
    assert names == {file.stem for file in (ROOT / "cases").glob("*.toml")}
    assert all(name in listed for name in names)
    assert (moved / "share/sandglass/reference/golden/column.h5").exists()


@pytest.mark.parametrize(
    "file, arguments",
    [
        ("share/man/man1/sandglass.1", ["manual"]),
        ("share/bash-completion/completions/sandglass", ["completion", "bash"]),
    ],
)
def test_manual_and_completion_are_those_of_the_program(file, arguments, prefix):
    printed = run(prefix / "bin" / "sandglass", *arguments, cwd=ROOT)
    assert (prefix / file).read_text() == printed and "--limit" in printed.replace("\\", "")


def test_what_is_installed_reads_and_writes_for_other_programs(prefix, tmp_path):
    """Program and module use their own copies of exchange/ and common/, not those of the source."""
    moved = shutil.copytree(prefix, tmp_path / "elsewhere")
    program = moved / "bin" / "sandglass"
    run(program, "mesh", "column", "-o", tmp_path / "column.vtu", cwd=tmp_path)
    assert (tmp_path / "column.vtu").stat().st_size > 1000
    converter = moved / "share/sandglass/exchange/convert.py"
    converter.write_text("import sys\nsys.exit(print('the copy') or 2)\n")
    done = ran(program, "mesh", "column", "-o", tmp_path / "again.vtu", cwd=tmp_path)
    assert done.returncode == 2 and "the copy" in done.stderr

    modules = moved / "lib/python3/dist-packages"
    if not modules.exists():
        return  # built without it
    script = "import sandglass, sys; sandglass.Simulation(sys.argv[1])"
    done = ran(
        "/usr/bin/python3",
        "-c",
        script,
        ROOT / "exchange/example/hook.toml",
        env={"PYTHONPATH": str(modules)},
    )
    assert "mesh.file: the copy" in done.stderr


AVX2 = """
#include <cstdio>
#include <vector>
std::vector<double> ones(64, 1.0);
double sum = [] {
  double total = 0.0;
  for (std::size_t k = 0; k < ones.size(); ++k) total += ones[k] * static_cast<double>(k);
  return total;
}();
int main() { std::printf("%g\\n", sum); }
"""


@pytest.mark.skipif(shutil.which("qemu-x86_64") is None, reason="qemu-user is not installed")
@pytest.mark.skipif(platform.machine() != "x86_64", reason="for x86-64 compilers")
@pytest.mark.parametrize("processor, code", [("Haswell", 0), ("Nehalem", 3)])
def test_packages_refuse_a_processor_without_their_instructions(processor, code, tmp_path):
    """Before initialisers that need them, which would crash here without the check."""
    (tmp_path / "main.cpp").write_text(AVX2)
    v3, all_processors = ["-O3", "-march=x86-64-v3"], ["-O3", "-march=x86-64"]
    run("c++", *v3, "-ffast-math", "-c", "main.cpp", cwd=tmp_path)
    run("c++", *all_processors, "-c", ROOT / "app/processor_check.cpp", cwd=tmp_path)
    run("c++", "main.o", "-o", "bare", cwd=tmp_path)
    run("c++", "main.o", "processor_check.o", "-o", "checked", cwd=tmp_path)
    for program in ("bare", "checked"):
        command = ["qemu-x86_64", "-cpu", processor, tmp_path / program]
        done = ran(*command, cwd=tmp_path)
        if program == "bare" and code:
            assert done.returncode < 0
        else:
            assert done.returncode == code
            assert (done.stdout == "2016\n") == (code == 0)
            assert ("lacks instructions of x86-64-v3" in done.stderr) == (code != 0)


def test_other_versions_are_refused(tmp_path):
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(later LANGUAGES CXX)\n"
        "find_package(sandglass 9.0 REQUIRED)\n"
    )
    done = ran("cmake", "-S", tmp_path, "-B", tmp_path / "build", f"-Dsandglass_DIR={BUILD}")
    assert done.returncode != 0 and "9.0" in done.stderr
