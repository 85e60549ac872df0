#pragma once

#include <pybind11/pybind11.h>

namespace sandglass {

/// Adds the class Batch, on which the package's class of this name is built.
void add_batches(pybind11::module_& module);

}  // namespace sandglass
