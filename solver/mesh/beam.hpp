#pragma once

#include <string_view>
#include <tuple>

#include "base/parameter.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// A straight or twisted beam from the origin along x; its rectangular section is centred on the axis. Its
/// elements are boxes, or slanted: the trapezoids and parallelograms of MacNeal and Harder 1985 have 45
/// degrees.
struct BeamMesh {
  static constexpr std::string_view name = "beam";
  static constexpr std::string_view summary =
      "a beam along x, straight or twisted, with box-shaped or slanted elements";

  std::array<double, 3> size{};
  std::array<int, 3> elements{};
  double slant = 0.0;
  double alternating_slant = 0.0;
  double twist = 0.0;

  static constexpr auto parameters() {
    using M = BeamMesh;
    return std::tuple{
        Parameter{&M::size, "size", "m", Range::positive(),
                  "length along x, width along y, thickness along z"},
        Parameter{&M::elements, "elements", "-", Range::at_least(1), "hexahedra along x, y, z"},
        Parameter{&M::slant, "slant", "-", Range::any(),
                  "slope dx/dy of the faces between elements; 1: parallelograms of 45 degrees", false},
        Parameter{&M::alternating_slant, "alternating_slant", "-", Range::any(),
                  "the same with alternating sign; 1: trapezoids of 45 degrees", false},
        Parameter{&M::twist, "twist", "deg", Range::any(), "rotation of the section about x from end to end",
                  false}};
  }

  Mesh build() const;
};

}  // namespace sandglass
