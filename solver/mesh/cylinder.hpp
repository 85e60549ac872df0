#pragma once

#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// A cylinder along z, its base on z = 0: an O-grid (bulged core square, rings) swept in equal layers.
struct CylinderMesh {
  static constexpr std::string_view name = "cylinder";
  static constexpr std::string_view summary =
      "a cylinder along z: O-grid of a bulged core and rings, swept in layers";

  double radius = 0.0;
  double height = 0.0;
  int core_elements = 0;
  int rings = 0;
  int layers = 0;
  double core_size = 0.55;
  double core_bulge = 0.6;

  static constexpr auto parameters() {
    using M = CylinderMesh;
    return std::tuple{
        Parameter{&M::radius, "radius", "m", Range::positive(), "radius"},
        Parameter{&M::height, "height", "m", Range::positive(), "height along z"},
        Parameter{&M::core_elements, "core_elements", "-", Range::at_least(1),
                  "quadrilaterals along a core edge"},
        Parameter{&M::rings, "rings", "-", Range::at_least(1), "rings of quadrilaterals around the core"},
        Parameter{&M::layers, "layers", "-", Range::at_least(1), "layers of hexahedra along z"},
        Parameter{&M::core_size, "core_size", "-", Range::between(0.0, 1.0),
                  "size of the core in the unit disc", false},
        Parameter{&M::core_bulge, "core_bulge", "-", Range::at_least(0.0),
                  "share of the disc in the core's shape, in addition to half of the square", false}};
  }

  Mesh build() const;
};

}  // namespace sandglass
