#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "problem/model.hpp"

namespace sandglass::verification {

/// Writes what a reader of meshes and references looks for, with objects replaced as `bytes` say: other
/// classes of type, ranks, shapes, values and links.
void write_odd_file(const Scene& scene, std::span<const std::byte> bytes, const std::filesystem::path& path);

}  // namespace sandglass::verification
