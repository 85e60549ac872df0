#pragma once

#include "element/formulation.hpp"

namespace sandglass::verification {

/// One element moved along a path of nodal displacements step by step, without a mesh: any method, any number
/// type.
template <class Kernel, class Law, class T = double>
class SingleElement {
 public:
  SingleElement(const NodalVectors<double>& X, const Law& law,
                const HourglassSettings& settings = {}) requires std::is_same_v<T, double>
      : SingleElement(X, law, Kernel::precompute(X, law, settings)) {}

  SingleElement(const NodalVectors<double>& X, const Law& law,
                const typename Kernel::template Element<T>& element)
      : X_(from_double<T>(X)), law_(law), element_(element), u_(from_double<T>(NodalVectors<double>{})) {
    if constexpr (Kernel::remembers) history_ = {};
  }

  /// Moves to displacements u (m) and returns the forces there (N). The inverse step (1/s) is zero in static
  /// solutions.
  NodalVectors<T> to(const NodalVectors<T>& u, double inverse_step = 0.0) {
    motion_ = {
        .u = to_modes(u), .increment = to_modes(u - u_), .X = to_modes(X_), .inverse_step = T(inverse_step)};
    u_ = u;
    return from_modes(Kernel::force(Kernel::deformation(motion_, element_), element_, history_, law_));
  }

  // At the last displacements.
  ElementEnergy<T> energy() const { return Kernel::energy(motion_, element_, history_, law_); }
  T mean_jacobian() const { return Kernel::mean_jacobian(motion_, element_); }
  T stiffness_bound() const { return Kernel::stiffness_bound(motion_, element_, history_, law_); }

 private:
  NodalVectors<T> X_;
  Law law_;
  typename Kernel::template Element<T> element_;
  typename Kernel::template History<T> history_;
  NodalVectors<T> u_;
  ElementMotion<T> motion_;
};

}  // namespace sandglass::verification
