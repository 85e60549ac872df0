# The package that other projects find by find_package(sandglass), installed or in the build folder. Each target installs its own files;
# the component `runtime` has the files of a wheel beside its module (setup.py).
include(CMakePackageConfigHelpers)

install(TARGETS sandglass_library EXPORT sandglassTargets ARCHIVE DESTINATION lib LIBRARY DESTINATION lib)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/exchange ${PROJECT_SOURCE_DIR}/common DESTINATION ${SANDGLASS_SHARE} COMPONENT runtime
  FILES_MATCHING PATTERN "*.py" PATTERN tests EXCLUDE PATTERN example EXCLUDE PATTERN __pycache__ EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${SANDGLASS_SHARE} COMPONENT runtime)

set(SANDGLASS_PACKAGE lib/cmake/sandglass)
install(EXPORT sandglassTargets NAMESPACE sandglass:: DESTINATION ${SANDGLASS_PACKAGE})
export(EXPORT sandglassTargets NAMESPACE sandglass:: FILE ${PROJECT_BINARY_DIR}/sandglassTargets.cmake)
configure_package_config_file(sandglassConfig.cmake.in ${PROJECT_BINARY_DIR}/sandglassConfig.cmake
  INSTALL_DESTINATION ${SANDGLASS_PACKAGE} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sandglassConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sandglassConfig.cmake ${PROJECT_BINARY_DIR}/sandglassConfigVersion.cmake
  DESTINATION ${SANDGLASS_PACKAGE})
