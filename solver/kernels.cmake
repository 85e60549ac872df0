# Sources that are made from the lists of methods and number types, so that a build costs methods + laws: a change of one method
# compiles its own.
set(GENERATED ${CMAKE_CURRENT_BINARY_DIR}/kernels)

# Makes `output` from a template and adds it to a target.
function(add_generated target template output)
  configure_file(${template} ${GENERATED}/${output} @ONLY)
  target_sources(${target} PRIVATE ${GENERATED}/${output})
endfunction()

# Kernels that compute one element at a time, for the tests and benchmarks that compare with them.
add_library(sandglass_scalar OBJECT)
target_link_libraries(sandglass_scalar PRIVATE sandglass)

# The laws that kernels call: for the number types that run, that count and that differentiate.
set(NUMBERS "Pack<double>" "Pack<float>" "double" "Counted" "Dual<double>")
set(NAMES packed_double packed_float scalar_double counted dual)
foreach(NUMBER NAME IN ZIP_LISTS NUMBERS NAMES)
  add_generated(sandglass_library material/called_law_source.cpp.in called_law_${NAME}.cpp)
endforeach()

# For each method its facts, and its kernels for the number types that run; methods of one header share the kernels of the first.
file(GLOB METHODS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/element/methods CONFIGURE_DEPENDS element/methods/*.hpp)
foreach(HEADER IN LISTS METHODS)
  get_filename_component(METHOD ${HEADER} NAME_WE)
  file(STRINGS element/methods/${HEADER} TYPES REGEX "^struct ")
  list(TRANSFORM TYPES REPLACE "^struct ([A-Za-z0-9]+).*" "\\1")
  list(GET TYPES 0 TYPE)
  list(JOIN TYPES ">();\ntemplate MethodEntry method_entry<" ENTRIES)
  add_generated(sandglass_library assembly/method_entry_source.cpp.in ${METHOD}/method_entry.cpp)
  set_source_files_properties(${GENERATED}/${METHOD}/method_entry.cpp PROPERTIES COMPILE_OPTIONS "${QUICKLY}")
  foreach(REAL double float)
    set(NUMBER "Pack<${REAL}>")
    set(ASSEMBLE "assemble<${TYPE}, ${NUMBER}>")
    add_generated(sandglass_library assembly/assemble_source.cpp.in ${METHOD}/assemble_packed_${REAL}.cpp)
  endforeach()
  set(NUMBER double)
  set(ASSEMBLE "assemble_scalar<${TYPE}>")
  add_generated(sandglass_scalar assembly/assemble_source.cpp.in ${METHOD}/assemble_scalar.cpp)
endforeach()
