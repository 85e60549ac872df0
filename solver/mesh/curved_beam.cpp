#include "mesh/curved_beam.hpp"

#include <cmath>
#include <numbers>

#include "mesh/lattice.hpp"

namespace sandglass {

Mesh CurvedBeamMesh::build() const {
  const double radians = angle * std::numbers::pi / 180.0;
  return lattice(elements, [&](const Vector& s) {
    const double r = inner_radius + s[1] * width;
    return Vector{r * std::sin(radians * s[0]), r * std::cos(radians * s[0]), s[2] * thickness};
  });
}

}  // namespace sandglass
