#pragma once

#include <filesystem>

#include "model/model.hpp"

namespace sandglass {

/// Displacements (m) of a stored golden or truth at the nodes of the scene. Throws InputError when the file
/// is missing or broken, and when its hashes are not those of the scene; the text names the command that
/// makes it anew.
NodalField read_reference(const std::filesystem::path& path, const Scene& scene);

}  // namespace sandglass
