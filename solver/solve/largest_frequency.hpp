#pragma once

#include <vector>

#include "assembly/internal_force.hpp"
#include "assembly/row_ties.hpp"

namespace sandglass {

/// The largest frequency of small motions of a body, tracked through a run. It is below the bounds of single
/// elements, because the fastest motions of neighbours are not compatible.
template <class Real>
class LargestFrequency {
 public:
  explicit LargestFrequency(std::size_t elements) : bounds_(elements, 0.0) {}

  /// Its square (1/s^2) at a state: an earlier value times the largest growth since then of an element's
  /// stiffness bound (N/m). It is recomputed once this growth is a tenth, or the largest bound has fallen as
  /// much, or bounds have differed for ten calls. Infinite if unknown, because forces depend on more than
  /// displacements or are not finite. Over `most`, the square for single elements, it is a whole power of
  /// 2^(-1/32), rounded up, so that roundoff, which depends on units and directions, does not affect the
  /// steps. `inverse_masses` (1/kg) are zero on components that are not free.
  double square(const Mesh& mesh, const ElementForces<Real>& elements, const RowTies<Real>& ties,
                const Rows<Real>& inverse_masses, const State<Real>& state, const std::vector<double>& bounds,
                double most);

  /// The data that the next call depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    archive("largest frequency", square_);
    archive("bounds at largest frequency", bounds_);
    archive("age of largest frequency", age_);
  }

 private:
  double square_ = 0.0;         // 0 before the first computation
  std::vector<double> bounds_;  // at that time, N/m
  int age_ = 0;                 // calls with other bounds
};

extern template class LargestFrequency<double>;
extern template class LargestFrequency<float>;

}  // namespace sandglass
