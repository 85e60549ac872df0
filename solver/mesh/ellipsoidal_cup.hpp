#pragma once

#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// A cup between two ellipsoids of revolution about the z axis, closed below and cut off by a plane across
/// the axis: the ventricle of Land et al. (Proc. R. Soc. A 471, 2015, 20150641). An O-grid of the disc is
/// bent onto each of the surfaces between the two.
struct EllipsoidalCupMesh {
  static constexpr std::string_view name = "ellipsoidal-cup";
  static constexpr std::string_view summary =
      "a thick cup between two ellipsoids about the origin, cut off by a plane across the z axis";

  double radius = 0.0;
  double length = 0.0;
  double thickness = 0.0;
  double rim = 0.0;
  int core_elements = 0;
  int rings = 0;
  int layers = 0;

  static constexpr auto parameters() {
    using M = EllipsoidalCupMesh;
    return std::tuple{
        Parameter{&M::radius, "radius", "m", Range::positive(), "inner semi-axis across z"},
        Parameter{&M::length, "length", "m", Range::positive(), "inner semi-axis along z"},
        Parameter{&M::thickness, "thickness", "m", Range::positive(), "outer minus inner semi-axes"},
        Parameter{&M::rim, "rim", "m", Range::any(), "z of the rim, within the length; the cup is below",
                  false},
        Parameter{&M::core_elements, "core_elements", "-", Range::at_least(1),
                  "quadrilaterals along an edge of the square core around the lowest point"},
        Parameter{&M::rings, "rings", "-", Range::at_least(1),
                  "rings of quadrilaterals from there to the rim"},
        Parameter{&M::layers, "layers", "-", Range::at_least(1), "layers of hexahedra through the wall"}};
  }

  /// The mesh; its elements are inverted if the rim is not within the length.
  Mesh build() const;
};

}  // namespace sandglass
