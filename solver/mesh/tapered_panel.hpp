#pragma once

#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// A panel between two upright edges of different height, such as Cook's membrane; z = 0 is one of its faces.
struct TaperedPanelMesh {
  static constexpr std::string_view name = "tapered-panel";
  static constexpr std::string_view summary = "a panel between two upright edges of different height";

  double width = 0.0;
  std::array<double, 2> left{};
  std::array<double, 2> right{};
  double thickness = 0.0;
  std::array<int, 3> elements{};

  static constexpr auto parameters() {
    using M = TaperedPanelMesh;
    return std::tuple{
        Parameter{&M::width, "width", "m", Range::positive(),
                  "width from the left edge, x = 0, to the right edge"},
        Parameter{&M::left, "left", "m", Range::any(), "y of lower and upper end of the left edge"},
        Parameter{&M::right, "right", "m", Range::any(), "y of lower and upper end of the right edge"},
        Parameter{&M::thickness, "thickness", "m", Range::positive(), "thickness along z, from z = 0"},
        Parameter{&M::elements, "elements", "-", Range::at_least(1), "hexahedra along x, y, z"}};
  }

  /// The mesh; its elements are inverted if an upper end is not above the lower one.
  Mesh build() const;
};

}  // namespace sandglass
