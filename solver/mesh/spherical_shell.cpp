#include "mesh/spherical_shell.hpp"

#include <cmath>
#include <numbers>

#include "mesh/lattice.hpp"

namespace sandglass {

Mesh SphericalShellMesh::build() const {
  constexpr double degree = std::numbers::pi / 180.0;
  return lattice(elements, [this](const Vector& s) {
    const double longitude = s[0] * angle * degree, latitude = s[1] * (90.0 - hole) * degree;
    const double r = radius + (s[2] - 0.5) * thickness;
    return Vector{r * std::cos(latitude) * std::cos(longitude), r * std::cos(latitude) * std::sin(longitude),
                  r * std::sin(latitude)};
  });
}

}  // namespace sandglass
