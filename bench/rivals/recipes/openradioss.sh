#!/usr/bin/env bash
# Builds OpenRadioss (starter and engine, one process, double precision) with its authors' flags, without the libraries that its own build
# downloads: Debian's in their place, the open reader instead of the closed one, no H3D output. With a network the authors' way is
# `./build_script.sh -arch=linux64_gf` in starter/ and engine/; the element loops are the same.
#   git clone https://github.com/OpenRadioss/OpenRadioss && git -C OpenRadioss checkout bd4557b
#   bash bench/rivals/recipes/openradioss.sh OpenRadioss bin               # bin/openradioss_starter, openradioss_engine
#   NATIVE=1 bash bench/rivals/recipes/openradioss.sh OpenRadioss bin      # bin/openradioss_engine-native, with -O3 -march=native
# Packages: build-essential gfortran cmake ninja-build python3 liblapack-dev libblas-dev libmetis-dev zlib1g-dev libboost-filesystem-dev.
# To run: RAD_CFG_PATH=OpenRadioss/hm_cfg_files LD_LIBRARY_PATH=OpenRadioss/exec
set -euo pipefail
source=$(realpath "$1")
mkdir -p "$2"
bin=$(realpath "$2")
cd "$source"
compilers=(-G Ninja -DCMAKE_Fortran_COMPILER=gfortran -DCMAKE_C_COMPILER=gcc -DCMAKE_CXX_COMPILER=g++)
options=(-Darch=linux64_gf -Dprecision=dp -Ddebug=0 -Dstatic_link=0 -Dno_python=0)

if [ ! -d extlib ]; then
  # 1. Stand-ins for the libraries that are downloaded.
  libraries=/usr/lib/$(gcc -print-multiarch)
  mkdir -p extlib/{md5/include,md5/linux64,zlib/linux64/include,zlib/linux64/lib,metis/linux64,exprtk,h3d/includes} \
    extlib/lapack-3.10.0/lib_linux64_gf extlib/boost/boost_1_70_0/static/lib/linux64
  ln -s /usr/include/{zlib,zconf}.h extlib/zlib/linux64/include/
  ln -s "$libraries/libz.a" extlib/zlib/linux64/lib/libz.a
  ln -s "$libraries/libmetis.so" extlib/metis/linux64/libmetis_linux64_gcc.a
  ln -s "$libraries/liblapack.a" extlib/lapack-3.10.0/lib_linux64_gf/liblapack.a
  ln -s "$libraries/libblas.a" extlib/lapack-3.10.0/lib_linux64_gf/librefblas.a
  ar rcs extlib/lapack-3.10.0/lib_linux64_gf/libtmglib.a
  ln -s /usr/include/boost extlib/boost/boost_1_70_0/boost
  ln -s "$libraries/libboost_filesystem.so" extlib/boost/boost_1_70_0/static/lib/linux64/libboost_filesystem.a
  # Check sums of output files, and formulas in decks: neither matters here.
  cat >extlib/md5/include/md5.h <<'MD5'
#pragma once
typedef unsigned char md5_byte_t;
typedef struct { int unused; } md5_state_t;
static inline void md5_init(md5_state_t* s) { (void)s; }
static inline void md5_append(md5_state_t* s, const md5_byte_t* d, int n) { (void)s, (void)d, (void)n; }
static inline void md5_finish(md5_state_t* s, md5_byte_t d[16]) { (void)s; for (int i = 0; i < 16; ++i) d[i] = 0; }
MD5
  ar rcs extlib/md5/linux64/libmd5.a
  cat >extlib/exprtk/exprtk.hpp <<'EXPRTK'
#pragma once
#include <cstdlib>
#include <string>
namespace exprtk {
template <class T> struct expression { T number = 0; T value() const { return number; } };
template <class T> struct parser {
  bool compile(const std::string& text, expression<T>& e) {
    char* end = nullptr;
    e.number = std::strtod(text.c_str(), &end);
    return end && *end == 0;
  }
};
}  // namespace exprtk
EXPRTK
  : >Compiling_tools/script/load_extlib.py # downloads
  # 2. The open reader does not know the name of the deck format of this revision.
  kernel=reader/source/cfgkernel/KERNEL
  sed -i 's/^  FF_D00_2026,/&\n  FF_D00_2612,/' $kernel/mv_file_format.h
  sed -i -E 's/^(.*)radioss2026(.*)FF_D00_2026;/&\n\1radioss2612\2FF_D00_2612;/; s/^(.*)\[FF_D00_2026\](.*)"radioss2026";/&\n\1[FF_D00_2612]\2"radioss2612";/' $kernel/mv_file_format.cpp
  sed -i 's/^    if (ff_id >= FF_D00_2026)  .*/    if (ff_id >= FF_D00_2612) a_ff_p = getFileFormatPtr(FF_D00_2612);\n    if (a_ff_p == NULL \&\& ff_id >= FF_D00_2026) a_ff_p = getFileFormatPtr(FF_D00_2026);/' $kernel/mv_descriptor.cpp
  sed -i 's/versions = { "radioss2026",/versions = { "radioss2612", "radioss2026",/' $kernel/mv_utils.cpp
  sed -i 's/= "radioss2026:radioss2025/= "radioss2612:radioss2026:radioss2025/' $kernel/cfg_kernel.cpp
  # 3. The open reader does not make rigid bodies of parts; the H3D writer is closed.
  sed -i 's/^\( *\)call cpp_evaluate_rbodies_number_from_rigid_parts.*/\1NBRBODIES_PER_PART(1:NPART) = 0/' \
    starter/source/devtools/hm_reader/hm_evaluate_rbodies_from_rigid_parts.F90
  cat >starter/stub/open_reader.c <<'STUB'
void cpp_create_rbodies_from_rigid_parts_(void* a) { (void)a; }
void cpp_is_part_with_elements_(int* id, char* filled) { (void)id, (void)filled; }
void cpp_sale_mesh_create_(void* a) { (void)a; }
STUB
  # What else is left out is never called by our decks.
  for part in starter engine; do
    echo 'string(APPEND LINK " -Wl,--unresolved-symbols=ignore-all")' >>$part/CMake_Compilers/cmake_linux64_gf.txt
  done
  cat >>engine/CMake_Compilers/cmake_linux64_gf.txt <<'ENGINE'
list(FILTER cpp_source_files EXCLUDE REGEX "/h3d_build_cpp/")
list(FILTER c_source_files EXCLUDE REGEX "/h3d_build_cpp/")
if(NATIVE)
  foreach(file ${source_files})
    get_source_file_property(flags ${file} COMPILE_FLAGS)
    set_source_files_properties(${file} PROPERTIES COMPILE_FLAGS "${flags} -O3 -march=native -w")
  endforeach()
endif()
ENGINE
fi

build() { # FOLDER BUILD-FOLDER OPTIONS...
  cmake "${compilers[@]}" -S "$1" -B "$1/$2" "${@:3}"
  cmake --build "$1/$2" --parallel "$(nproc)"
}
engine=(-DMPI=smp -Dsanitize=0 -Dprecice=0 -Dcwipi=0)
if [ -n "${NATIVE:-}" ]; then
  build engine build-native "${options[@]}" "${engine[@]}" -DEXEC_NAME=engine_native -DNATIVE=1
  cp exec/engine_native "$bin/openradioss_engine-native"
  exit
fi
build reader cbuild_linux64 -Darch=linux64 -Dcom=0
build starter build "${options[@]}" -DEXEC_NAME=starter_linux64_gf -DUSE_OPEN_READER=1
build engine build "${options[@]}" "${engine[@]}" -DEXEC_NAME=engine_linux64_gf
cp exec/starter_linux64_gf "$bin/openradioss_starter"
cp exec/engine_linux64_gf "$bin/openradioss_engine"
