#pragma once

#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// A part of a spherical shell about the origin, from its equator at z = 0 up to a hole about the z axis, and
/// from the plane y = 0 around the axis. The default is a quarter of MacNeal and Harder's hemisphere with a
/// hole of 18 degrees.
struct SphericalShellMesh {
  static constexpr std::string_view name = "spherical-shell";
  static constexpr std::string_view summary = "a spherical shell from its equator to a hole at its top";

  double radius = 0.0;
  double thickness = 0.0;
  double hole = 18.0;
  double angle = 90.0;
  std::array<int, 3> elements{};

  static constexpr auto parameters() {
    using M = SphericalShellMesh;
    return std::tuple{
        Parameter{&M::radius, "radius", "m", Range::positive(), "radius of the middle surface"},
        Parameter{&M::thickness, "thickness", "m", Range::positive(),
                  "thickness, half inside and half outside"},
        Parameter{&M::hole, "hole", "deg", Range::between(0.0, 90.0), "angle between the z axis and the rim",
                  false},
        Parameter{&M::angle, "angle", "deg", Range::between(0.0, 360.0),
                  "angle around the z axis, from the x axis", false},
        Parameter{&M::elements, "elements", "-", Range::at_least(1),
                  "hexahedra around the axis, from the equator to the rim, through the thickness"}};
  }

  /// The mesh; its elements are inverted if it is thicker than twice the radius.
  Mesh build() const;
};

}  // namespace sandglass
