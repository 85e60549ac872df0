#pragma once

#include <optional>
#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// An ellipsoid about the origin as a cubed sphere: a bulged core lattice and shell layers around it.
struct EllipsoidMesh {
  static constexpr std::string_view name = "ellipsoid";
  static constexpr std::string_view summary =
      "an ellipsoid about the origin: bulged core lattice and shell layers";

  std::array<double, 3> semi_axes{};
  int core_elements = 0;
  int shell_layers = 0;
  double core_size = 0.62;
  double core_bulge = 0.625;
  Vector focus{};

  static constexpr auto parameters() {
    using M = EllipsoidMesh;
    return std::tuple{
        Parameter{&M::semi_axes, "semi_axes", "m", Range::positive(), "semi-axes along x, y, z"},
        Parameter{&M::core_elements, "core_elements", "-", Range::at_least(1),
                  "hexahedra along each edge of the core"},
        Parameter{&M::shell_layers, "shell_layers", "-", Range::at_least(1),
                  "layers of hexahedra around the core"},
        Parameter{&M::core_size, "core_size", "-", Range::between(0.0, 1.0),
                  "size of the core in the unit ball", false},
        Parameter{&M::core_bulge, "core_bulge", "-", Range::at_least(0.0),
                  "share of the ball in the core's shape, in addition to half of the cube", false},
        Parameter{
            &M::focus, "focus", "-", Range::between(-1.0, 1.0),
            "where in the unit ball its centre is moved to, f from it: elements next to it are smaller, on "
            "the surface by (1 - f) / (1 + f), and far from it larger",
            false}};
  }
  std::optional<BrokenRule> broken_rule() const;

  Mesh build() const;
};

}  // namespace sandglass
