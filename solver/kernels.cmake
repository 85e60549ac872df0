# Sources that are made from the lists of methods and number types, so that a build costs methods + laws: a change of one method
# compiles its own.

# Makes `output` from a template, in the folder `kernels` of the caller's build folder, and adds it to a target.
function(add_generated target template output)
  configure_file(${template} ${CMAKE_CURRENT_BINARY_DIR}/kernels/${output} @ONLY)
  target_sources(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/kernels/${output})
endfunction()

# The kernels of the library, which compute as many elements at a time as a register holds.
add_library(sandglass_packed OBJECT)
compile_as_library(sandglass_packed)
target_include_directories(sandglass_packed PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(sandglass_packed PRIVATE fmt::fmt OpenMP::OpenMP_CXX)
precompile_headers(sandglass_packed <assembly/assemble.hpp>)
target_sources(sandglass_library PRIVATE $<TARGET_OBJECTS:sandglass_packed>)

# Kernels that compute one element at a time, for the tests and benchmarks that compare with them.
add_library(sandglass_scalar OBJECT)
target_link_libraries(sandglass_scalar PRIVATE sandglass)
precompile_headers(sandglass_scalar <assembly/assemble.hpp>)

# The laws that kernels call, for a number type and its header.
function(add_called_law target number header name)
  set(NUMBER ${number})
  set(INCLUDE ${header})
  add_generated(${target} ${PROJECT_SOURCE_DIR}/solver/material/called_law_source.cpp.in called_law_${name}.cpp)
endfunction()
add_called_law(sandglass_packed "Pack<double>" math/pack.hpp packed_double)
add_called_law(sandglass_packed "Pack<float>" math/pack.hpp packed_float)
add_called_law(sandglass_packed "double" math/scalar.hpp scalar_double)
add_called_law(sandglass_packed "Dual<double>" math/dual.hpp dual)

# For each method its facts, and its kernels for the number types that run; methods of one header share the kernels of the first.
file(GLOB METHODS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/element/methods CONFIGURE_DEPENDS element/methods/*.hpp)
foreach(HEADER IN LISTS METHODS)
  get_filename_component(METHOD ${HEADER} NAME_WE)
  file(STRINGS element/methods/${HEADER} TYPES REGEX "^struct ")
  list(TRANSFORM TYPES REPLACE "^struct ([A-Za-z0-9]+).*" "\\1")
  list(GET TYPES 0 TYPE)
  list(JOIN TYPES ">();\ntemplate MethodEntry method_entry<" ENTRIES)
  # Of the library: it must not see the definition of `assemble`, or it would contain the scalar kernels.
  add_generated(sandglass_library assembly/method_entry_source.cpp.in ${METHOD}/method_entry.cpp)
  foreach(REAL double float)
    set(NUMBER "Pack<${REAL}>")
    set(ASSEMBLE "assemble<${TYPE}, ${NUMBER}>")
    add_generated(sandglass_packed assembly/assemble_source.cpp.in ${METHOD}/assemble_packed_${REAL}.cpp)
  endforeach()
  file(STRINGS element/methods/${HEADER} BATCHES REGEX " batches = true")
  if(BATCHES)
    foreach(REAL double float)
      set(NUMBER "Pack<${REAL}>")
      add_generated(sandglass_packed assembly/batch_source.cpp.in ${METHOD}/batch_${REAL}.cpp)
    endforeach()
  endif()
  set(NUMBER double)
  set(ASSEMBLE "assemble_scalar<${TYPE}>")
  add_generated(sandglass_scalar assembly/assemble_source.cpp.in ${METHOD}/assemble_scalar.cpp)
endforeach()
