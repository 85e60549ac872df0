#pragma once

#include <filesystem>
#include <string>

namespace sandglass {

/// A folder of this project, "cases" or "exchange": that which is installed with the running program or with
/// the Python module, else that of the source, else that of the prefix for which the library was built.
std::filesystem::path project_folder(const std::string& name);

}  // namespace sandglass
