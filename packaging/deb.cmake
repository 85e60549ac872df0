# The Debian package, made by ci/package with the preset `portable`: program, library, headers, Python module, cases, references.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Sandglass authors <authors@sandglass.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "explicit solver for soft solids, with a verification suite
Total Lagrangian hexahedra with one integration point and hourglass control,
for real-time simulation of soft bodies, with cases and references to choose
the cheapest method that is accurate enough. Brings the program sandglass, the
C++ library with its CMake configuration, and the Python module sandglass.
Needs a processor with AVX2, FMA and BMI2.")

# The libraries that program and module load are determined from the binaries. The module is for the system's Python, which also
# converts files of other programs (exchange/).
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy, python3-h5py")
# apt also installs these, except with --no-install-recommends: first the packages with which find_package(sandglass) links the static
# library, then packages for some files of other programs.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS
  "libfmt-dev, libhdf5-dev, libmuparser-dev, libxxhash-dev, python3-meshio, python3-scipy")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake, g++, gmsh, paraview, python3-lz4, python3-nibabel")

# Licence and changes, where Debian expects them, only in the package.
set(CHANGES ${CMAKE_BINARY_DIR}/changelog)
string(TIMESTAMP NOW "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${CHANGES}.Debian "sandglass (${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) bookworm; urgency=medium

  * Made by ci/package; what is new is in changelog.gz.

 -- ${CPACK_PACKAGE_CONTACT}  ${NOW}
")
configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${CHANGES} COPYONLY)
foreach(file ${CHANGES} ${CHANGES}.Debian)
  execute_process(COMMAND gzip -9nc ${file} OUTPUT_FILE ${file}.gz)
endforeach()
install(FILES ${CHANGES}.gz ${CHANGES}.Debian.gz DESTINATION share/doc/sandglass COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION share/doc/sandglass RENAME copyright COMPONENT debian EXCLUDE_FROM_ALL)
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};sandglass;ALL;/;${CMAKE_BINARY_DIR};sandglass;debian;/")
include(CPack)
