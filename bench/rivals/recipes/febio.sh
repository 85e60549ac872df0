#!/usr/bin/env bash
# Builds FEBio 4.11 without Intel's MKL, so that its direct solver is the skyline one: the solid mechanics alone.
#   git clone https://github.com/febiosoftware/FEBio && git -C FEBio checkout 65622b5
#   bash bench/rivals/recipes/febio.sh FEBio bin              # bin/febio4, febio4-native
# Packages: build-essential cmake zlib1g-dev python3.
set -euo pipefail
source=$(realpath "$1")
mkdir -p "$2"
bin=$(realpath "$2")
cd "$source"
sed -i '0,/#include/s//#include <cstring>\n#include/' FECore/FSPath.cpp # GCC 12 wants it for strcpy
# MECH_ONLY, the authors' macro for solid mechanics alone, still refers to their library of tests.
python3 - <<'EDIT'
from pathlib import Path

config = Path("FEBioLib/config.cpp")
text = config.read_text()
header, test = "#include <FEBioTest/FEMaterialTest.h>", "bool RunMaterialTest(FEMaterial* mat"
none = (
    "bool RunMaterialTest(FEMaterial*, double, int, double, const char*, "
    "std::vector<pair<double, double> >&) { return false; }"
)
end = "} // namespace febio"
for old, new in (
    (header, f"#ifndef MECH_ONLY\n{header}\n#endif"),
    (f"\n{test}", f"\n#ifdef MECH_ONLY\n{none}\n#else\n{test}"),
    (f"\n{end}", f"\n#endif\n{end}"),
):
    assert old in text, old
    text = text.replace(old, new, 1)
config.write_text(text)

lists = Path("CMakeLists.txt")
text = lists.read_text()
start = text.index("target_link_libraries(febiolib PRIVATE febioplot febiomech")
libraries = "febioplot febiomech febioxml numcore feamr fecore"
end = text.index(")", start)
lists.write_text(f"{text[:start]}target_link_libraries(febiolib PRIVATE {libraries}{text[end:]}")
EDIT
build() {
  # Without HYPRE nothing else brings the library of OpenMP.
  cmake -S . -B "build-$1" -DCMAKE_BUILD_TYPE=Release -DCMAKE_EXE_LINKER_FLAGS=-fopenmp -DUSE_MKL=OFF -DUSE_HYPRE=OFF -DUSE_FFTW=OFF \
    -DCMAKE_CXX_FLAGS="-DMECH_ONLY $2"
  cmake --build "build-$1" --target febio4 --parallel "$(nproc)"
  ln -sf "$source/build-$1/bin/febio4" "$bin/$1"
}
build febio4 ""
build febio4-native "-O3 -march=native"
