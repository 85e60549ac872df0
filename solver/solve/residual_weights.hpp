#pragma once

#include <vector>

#include "multigrid/element_level.hpp"

namespace sandglass {

/// Weights of residuals: L^T with L L^T = D for forces, the roots of mu / V for pressures. Weighted, both
/// have the unit of a root of energy.
class ResidualWeights {
 public:
  explicit ResidualWeights(const ElementLevel& level) : diagonal_(level.zero()) {}

  /// Sets the weights of forces from the smoother's D, see SaddleLevel::relaxation.
  void set_forces(const ElementLevel& level);

  /// Sets the weight of one cell's pressure from its shear modulus (Pa) and volume (m^3).
  void set_pressure(std::size_t cell, double shear_modulus, double volume);

  /// residuals *= weights.
  void multiply(MixedVector& residuals, const MixedBlocks& blocks) const;

  /// residuals = factor * weighted / weights, zero on constrained components.
  void divide(float factor, const MixedVector& weighted, MixedVector& residuals,
              const MixedBlocks& blocks) const;

 private:
  /// The rest of a row's L, where a spring of contact is oblique to the axes.
  struct Coupling {
    std::size_t row;
    float yx, zx, zy;
  };

  MixedVector diagonal_;  // of L, roots of m/N; roots of Pa/m^3
  std::vector<Coupling> couplings_;
};

}  // namespace sandglass
