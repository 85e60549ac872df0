#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "mesh/mesh.hpp"

namespace sandglass {

/// 16 hexadecimal digits of XXH3 of a text.
std::string hash_of(std::string_view text);

/// A hash of a mesh, its node sets and the materials of its elements, if there are several. Coordinates enter
/// rounded to 1e-7 of the mesh's diagonal, so the last bits, which differ between compilers, do not matter.
std::string mesh_hash(const Mesh& mesh, const NodeSets& sets,
                      std::span<const std::uint16_t> material_of_element = {});

}  // namespace sandglass
