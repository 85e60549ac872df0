# The files of `cmake --install`, and the package that other projects find by find_package(sandglass), installed or in the build folder.
# The component `runtime` has the files of a wheel beside its module (setup.py).
include(CMakePackageConfigHelpers)

install(TARGETS sandglass_library EXPORT sandglassTargets ARCHIVE DESTINATION lib LIBRARY DESTINATION lib)
install(FILES sandglass/simulation.hpp sandglass/batch.hpp DESTINATION include/sandglass)
install(FILES base/error.hpp DESTINATION include/sandglass/base)  # the errors that it throws
install(DIRECTORY ${PROJECT_SOURCE_DIR}/cases DESTINATION ${SANDGLASS_SHARE} COMPONENT runtime
  FILES_MATCHING PATTERN "*.toml")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/reference/golden ${PROJECT_SOURCE_DIR}/reference/truth
  DESTINATION ${SANDGLASS_SHARE}/reference COMPONENT runtime FILES_MATCHING PATTERN "*.h5")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/exchange ${PROJECT_SOURCE_DIR}/common DESTINATION ${SANDGLASS_SHARE} COMPONENT runtime
  FILES_MATCHING PATTERN "*.py" PATTERN tests EXCLUDE PATTERN example EXCLUDE PATTERN __pycache__ EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${SANDGLASS_SHARE} COMPONENT runtime)

set(SANDGLASS_PACKAGE lib/cmake/sandglass)
install(EXPORT sandglassTargets NAMESPACE sandglass:: DESTINATION ${SANDGLASS_PACKAGE})
export(EXPORT sandglassTargets NAMESPACE sandglass:: FILE ${CMAKE_BINARY_DIR}/sandglassTargets.cmake)
configure_package_config_file(sandglassConfig.cmake.in ${CMAKE_BINARY_DIR}/sandglassConfig.cmake
  INSTALL_DESTINATION ${SANDGLASS_PACKAGE} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/sandglassConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_BINARY_DIR}/sandglassConfig.cmake ${CMAKE_BINARY_DIR}/sandglassConfigVersion.cmake
  DESTINATION ${SANDGLASS_PACKAGE})
