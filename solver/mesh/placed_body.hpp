#pragma once

#include <string>

#include "mesh/generators.hpp"
#include "mesh/mesh_with_sets.hpp"

namespace sandglass {

/// One of several bodies of a mesh: a generated mesh that is turned about the origin and then moved.
struct PlacedBody {
  std::string label;
  Vector turn{};
  Vector offset{};
  AnyGenerator generator = {};

  /// Those of the place; the generator has its own.
  static constexpr auto parameters() {
    using P = PlacedBody;
    return std::tuple{
        Parameter{&P::label, "name", "-", Range::any(), "also of the sets of its nodes and elements"},
        Parameter{&P::turn, "turn", "deg", Range::any(),
                  "a rotation about the origin: its direction is the axis, its length the angle", false},
        Parameter{&P::offset, "offset", "m", Range::any(), "a displacement after the rotation", false}};
  }
  std::optional<BrokenRule> broken_rule() const;
};

/// The mesh of all bodies in their order, without common nodes, and the sets of each body's nodes and
/// elements under its name.
MeshWithSets build(const std::vector<PlacedBody>& bodies);

}  // namespace sandglass
