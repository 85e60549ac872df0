# Sources generated from the lists of methods and number types, so that a build costs methods + laws: a change of one method compiles
# only its own.

# Makes `output` from a template, in the folder `kernels` of the caller's build folder, and adds it to a target.
function(add_generated target template output)
  configure_file(${template} ${CMAKE_CURRENT_BINARY_DIR}/kernels/${output} @ONLY)
  target_sources(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/kernels/${output})
endfunction()

# The kernels of the library, which compute as many elements at a time as a register holds; and those that compute one element at a time:
# for `sandglass-scalar`, which times them, and for tests.
add_library(sandglass_packed OBJECT)
add_library(sandglass_scalar OBJECT EXCLUDE_FROM_ALL)
add_library(sandglass_scalar_untimed OBJECT EXCLUDE_FROM_ALL)
foreach(target sandglass_packed sandglass_scalar sandglass_scalar_untimed)
  compile_as_library(${target})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE fmt::fmt OpenMP::OpenMP_CXX)
endforeach()
# Full optimisation is for their loops alone; see base/hot_loop.hpp. It aligns them only if the whole source is compiled so: without, the
# steps of tl-perturbation take a tenth longer in float.
foreach(target sandglass_packed sandglass_scalar)
  target_compile_options(${target} PRIVATE
    "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:-O1;-falign-functions;-falign-loops;-falign-jumps;-DSANDGLASS_OPTIMIZE_LOOPS>")
endforeach()
precompile_headers(sandglass_packed <assembly/kernels.hpp>)
reuse_precompiled_headers(sandglass_scalar sandglass_packed)
compile_quickly(sandglass_scalar_untimed)
compile_together(sandglass_scalar_untimed 8)
target_sources(sandglass_library PRIVATE $<TARGET_OBJECTS:sandglass_packed>)

# The laws that kernels call, for a number type and its header; a further argument is the type of their parameters. They are part of the
# library, where everything is fully optimised.
function(add_called_law target number header name)
  set(NUMBER ${number})
  set(VALUE double ${ARGN})
  list(GET VALUE -1 VALUE)
  set(INCLUDE ${header})
  add_generated(${target} ${PROJECT_SOURCE_DIR}/solver/material/called_law_source.cpp.in called_law_${name}.cpp)
endfunction()
add_called_law(sandglass_library "Pack<double>" math/pack.hpp packed_double)
add_called_law(sandglass_library "Pack<float>" math/pack.hpp packed_float)
add_called_law(sandglass_library "double" math/scalar.hpp scalar_double)
add_called_law(sandglass_library "Dual<double>" math/dual.hpp dual)
foreach(REAL double float)
  add_called_law(sandglass_library "Pack<${REAL}>" math/pack.hpp of_bodies_${REAL} "Pack<double, Pack<${REAL}>::width>")
endforeach()

foreach(REAL double float)
  set(NUMBER "Pack<${REAL}>")
  add_generated(sandglass_packed assembly/batch_kernels_source.cpp.in batch_${REAL}.cpp)
endforeach()

# The kernels of each method for the number types that run. A method's header, type and name are spelt alike: tl_none.hpp, TlNone,
# tl-none.
file(GLOB METHODS CONFIGURE_DEPENDS element/methods/*.hpp)
foreach(HEADER IN LISTS METHODS)
  get_filename_component(METHOD ${HEADER} NAME_WE)
  string(REPLACE _ - NAME ${METHOD})
  string(REPLACE _ ";" WORDS ${METHOD})
  set(TYPE)
  foreach(WORD IN LISTS WORDS)
    string(SUBSTRING ${WORD} 0 1 FIRST)
    string(SUBSTRING ${WORD} 1 -1 REST)
    string(TOUPPER ${FIRST} FIRST)
    string(APPEND TYPE ${FIRST}${REST})
  endforeach()
  set(INSTANCES)
  foreach(NUMBER Pack<double> Pack<float>)
    string(APPEND INSTANCES "template Kernels<${NUMBER}> kernels<${TYPE}, ${NUMBER}>();\n")
  endforeach()
  add_generated(sandglass_packed assembly/kernels_source.cpp.in ${METHOD}/packed.cpp)
  set(INSTANCES "template Kernels<double> scalar_kernels<${TYPE}>();\n")
  foreach(target sandglass_scalar sandglass_scalar_untimed)
    add_generated(${target} assembly/kernels_source.cpp.in ${METHOD}/scalar.cpp)
  endforeach()
endforeach()
