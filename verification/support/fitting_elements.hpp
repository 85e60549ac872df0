#pragma once

#include "element/element_motion.hpp"
#include "support/random_hexahedra.hpp"
#include "support/sample_law.hpp"

/// Random elements for any kernel: unsupported or inverted ones are drawn again.
namespace sandglass::verification {

/// Reference coordinates that the kernel accepts.
template <class Kernel>
NodalVectors<double> fitting_hexahedron(RandomGeometry& random) {
  for (;;) {
    const NodalVectors<double> X = random.hexahedron();
    if (Kernel::accepts(X)) return X;
  }
}

/// Displacements in which no integration point of the kernel is close to inversion; see
/// RandomGeometry::displacements.
template <class Kernel, class Law>
NodalVectors<double> fitting_displacements(RandomGeometry& random, const NodalVectors<double>& X,
                                           double smallest_stretch, double largest_stretch, double waviness) {
  const auto element = Kernel::precompute(X, sample_law<Law>(poisson_ratios[0]), {});
  for (;;) {
    const NodalVectors<double> u = random.displacements(X, smallest_stretch, largest_stretch, waviness);
    ElementMotion<double> motion{};
    motion.u = to_modes(u);
    motion.X = to_modes(X);
    if (Kernel::smallest_jacobian(motion, element) > 0.1) return u;
  }
}

}  // namespace sandglass::verification
