#!/usr/bin/env bash
# Builds NiftySim 2.5 as its authors ship it, with optimisation, and for this processor.
#   git clone https://github.com/eloygarcia/niftysim && git -C niftysim checkout 112137e
#   bash bench/rivals/recipes/niftysim.sh niftysim bin        # bin/niftysim-plain, niftysim, niftysim-native
# Packages: build-essential cmake. Plain cmake leaves CMAKE_BUILD_TYPE empty and so compiles without optimisation.
set -euo pipefail
source=$(realpath "$1")
mkdir -p "$2"
bin=$(realpath "$2")
# GCC 11 and later refuse to drop this const.
sed -i 's/static_cast<std::ostringstream&>/static_cast<const std::ostringstream\&>/' "$source/source/tledXMLExporter.tpp"
build() {
  cmake -S "$source" -B "$source/build-$1" "${@:2}"
  cmake --build "$source/build-$1" --target niftysim --parallel "$(nproc)"
  cp "$source/build-$1/source/niftysim" "$bin/$1"
}
build niftysim-plain
build niftysim -DCMAKE_BUILD_TYPE=Release
build niftysim-native -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS="-O3 -march=native"
