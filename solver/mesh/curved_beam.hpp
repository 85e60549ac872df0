#pragma once

#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// A beam along an arc about the z axis: it starts on the plane x = 0 and turns from y towards x.
struct CurvedBeamMesh {
  static constexpr std::string_view name = "curved-beam";
  static constexpr std::string_view summary = "a beam along an arc about z, from the plane x = 0";

  double inner_radius = 0.0;
  double width = 0.0;
  double thickness = 0.0;
  double angle = 0.0;
  std::array<int, 3> elements{};

  static constexpr auto parameters() {
    using M = CurvedBeamMesh;
    return std::tuple{
        Parameter{&M::inner_radius, "inner_radius", "m", Range::positive(), "radius of the inner face"},
        Parameter{&M::width, "width", "m", Range::positive(), "from the inner face to the outer one"},
        Parameter{&M::thickness, "thickness", "m", Range::positive(), "thickness along z, from z = 0"},
        Parameter{&M::angle, "angle", "deg", Range::between(0.0, 360.0), "angle of the arc"},
        Parameter{&M::elements, "elements", "-", Range::at_least(1),
                  "hexahedra along the arc, from the inner to the outer face, along z"}};
  }

  Mesh build() const;
};

}  // namespace sandglass
