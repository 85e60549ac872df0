#include "mesh/tapered_panel.hpp"

#include <cmath>

#include "mesh/lattice.hpp"

namespace sandglass {

Mesh TaperedPanelMesh::build() const {
  return lattice(elements, [this](const Vector& s) {
    const double low = std::lerp(left[0], right[0], s[0]), high = std::lerp(left[1], right[1], s[0]);
    return Vector{s[0] * width, std::lerp(low, high, s[1]), s[2] * thickness};
  });
}

}  // namespace sandglass
