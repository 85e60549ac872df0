#pragma once

#include <filesystem>
#include <string>

namespace sandglass {

/// A folder of this project, "cases" or "exchange": that which is installed next to the running program, else
/// that of the source.
std::filesystem::path project_folder(const std::string& name);

}  // namespace sandglass
