#include "mesh/box.hpp"

#include "mesh/lattice.hpp"

namespace sandglass {

Mesh BoxMesh::build() const {
  return lattice(elements, [this](const Vector& x) {
    return Vector{x[0] * size[0], x[1] * size[1], x[2] * size[2]};
  });
}

}  // namespace sandglass
