#pragma once

#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// A box with one corner at the origin, cut into equal hexahedra.
struct BoxMesh {
  static constexpr std::string_view name = "box";
  static constexpr std::string_view summary = "a box from the origin, equal hexahedra";

  std::array<double, 3> size{};
  std::array<int, 3> elements{};

  static constexpr auto parameters() {
    return std::tuple{
        Parameter{&BoxMesh::size, "size", "m", Range::positive(), "edge lengths along x, y, z"},
        Parameter{&BoxMesh::elements, "elements", "-", Range::at_least(1), "hexahedra along x, y, z"}};
  }

  Mesh build() const;
};

}  // namespace sandglass
