#pragma once

#include <pybind11/pybind11.h>

namespace sandglass {

/// Adds what the commands of the program compute, as functions of a dict of arguments and of a callback that
/// return the JSON text that the command writes. The package `sandglass` gives them their signatures.
void add_commands(pybind11::module_& module);

}  // namespace sandglass
