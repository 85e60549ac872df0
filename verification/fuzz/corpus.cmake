# Unpacks the corpus, one archive for each target, to ${CORPUS}/TARGET.
set(CORPUS ${PROJECT_BINARY_DIR}/corpus)
file(GLOB ARCHIVES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/verification/fuzz/corpus/*.tar.xz)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARCHIVES})
file(REMOVE_RECURSE ${CORPUS})
foreach(ARCHIVE ${ARCHIVES})
  get_filename_component(TARGET ${ARCHIVE} NAME_WE)
  file(ARCHIVE_EXTRACT INPUT ${ARCHIVE} DESTINATION ${CORPUS}/${TARGET})
endforeach()
