#include "mesh/beam.hpp"

#include <cmath>
#include <numbers>

#include "mesh/lattice.hpp"

namespace sandglass {

Mesh BeamMesh::build() const {
  const double radians = twist * std::numbers::pi / 180.0;
  return lattice(elements, [&](const Vector& s) {
    const double y = (s[1] - 0.5) * size[1], z = (s[2] - 0.5) * size[2];
    const auto face = static_cast<int>(std::lround(s[0] * elements[0]));
    const bool end = face == 0 || face == elements[0];
    const double slope = end ? 0.0 : slant + (face % 2 == 0 ? -alternating_slant : alternating_slant);
    const double c = std::cos(radians * s[0]), sine = std::sin(radians * s[0]);
    return Vector{s[0] * size[0] + slope * y, c * y - sine * z, sine * y + c * z};
  });
}

}  // namespace sandglass
