#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "math/rows.hpp"

namespace sandglass {

/// Energies of the whole mesh, J.
struct StrainEnergies {
  double strain = 0.0;
  double hourglass = 0.0;
};

/// The levels of a method's elements and their grouping; only the elements know its content.
class ElementLevels {
 public:
  ElementLevels() = default;
  ElementLevels(const ElementLevels&) = delete;
  ElementLevels& operator=(const ElementLevels&) = delete;
  virtual ~ElementLevels() = default;
};

/// The number of elements whose level changed.
struct Adaptation {
  std::size_t promoted = 0;  ///< elements
  std::size_t demoted = 0;
};

/// The variables of a simulation: nodal values in rows, in the order of the layout, and the elements'
/// history.
template <class Real>
struct State {
  Rows<Real> u;               ///< displacements, m
  Rows<Real> increment;       ///< their change in the last step, m
  std::vector<Real> history;  ///< of the elements; only they know its meaning
  std::shared_ptr<const ElementLevels> levels;
  double step = std::numeric_limits<double>::infinity();  ///< s, that the increment took; infinite where time
                                                          ///< plays no part
};

}  // namespace sandglass
