#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <new>
#include <string>

#include "sandglass/simulation.hpp"

namespace sandglass {

/// A base of classes of Python. Python can make an object whose constructor never runs, for example by
/// __new__: pybind11 then allocates memory that nobody fills. Here that memory is zero, so that `made_` is
/// false.
class NeverUnmade {
 public:
  // Inlined, as `delete` is; otherwise GCC 12 sees memory of a function that `free` does not match.
  [[gnu::always_inline]] static void* operator new(std::size_t size) {
    if (void* memory = std::calloc(1, size)) return memory;
    throw std::bad_alloc();
  }
  static void* operator new(std::size_t /*size*/, void* place) { return place; }
  static void operator delete(void* memory) { std::free(memory); }

 protected:
  /// Throws TypeError unless a constructor has run.
  void require_made(const char* name) const {
    if (!made_) throw pybind11::type_error(std::string(name) + ": this object was never initialized");
  }

 private:
  bool made_ = true;
};

/// Adds the functions `case_tables`, `mesh_of_keys` and `solve`, and the class `Answer`, on which the package
/// sandglass is built. `solve` has the arguments of Simulation::of_mesh, and threads.
void add_answers(pybind11::module_& module);

/// Arrays of a program as a mesh; see module.cpp. Throws InputError that names argument, shape and rule.
MeshArrays mesh_arrays(const pybind11::object& points, const pybind11::object& cells,
                       const std::map<std::string, pybind11::object>& sets,
                       const std::map<std::string, pybind11::object>& element_sets);

}  // namespace sandglass
