#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "problem/model.hpp"

namespace sandglass::verification {

/// Writes a file as readers of meshes and references expect it, except that `bytes` select objects to replace
/// by other classes of type, ranks, shapes, values and links.
void write_odd_file(const Scene& scene, std::span<const std::byte> bytes, const std::filesystem::path& path);

}  // namespace sandglass::verification
