#pragma once

#include <filesystem>
#include <string>

namespace sandglass {

/// A folder of this project, "cases" or "exchange": the one installed with the running program or the Python
/// module, else the one in the source tree, else the one in the prefix for which the library was built.
std::filesystem::path project_folder(const std::string& name);

}  // namespace sandglass
