#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>

#include "sandglass/simulation.hpp"

namespace sandglass {

/// Adds the functions `case_tables`, `mesh_of_keys` and `solve`, and the class `Answer`, on which the package
/// sandglass is built. `solve` has the arguments of Simulation::of_mesh, and threads.
void add_answers(pybind11::module_& module);

/// Arrays of a program as a mesh; see module.cpp. Throws InputError that names argument, shape and rule.
MeshArrays mesh_arrays(const pybind11::object& points, const pybind11::object& cells,
                       const std::map<std::string, pybind11::object>& sets,
                       const std::map<std::string, pybind11::object>& element_sets);

/// Throws InputError for a number of threads that must be a mistake.
void require_threads(int threads);

}  // namespace sandglass
