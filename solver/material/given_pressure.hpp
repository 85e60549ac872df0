#pragma once

#include "math/strain.hpp"

namespace sandglass {

/// A law without an isochoric part whose pressure does not depend on the deformation: with it, a kernel
/// computes the forces of a pressure p alone, p dV/du.
template <class T>
struct GivenPressure {
  T p;  ///< Pa, tension positive

  T pressure(const T& /*J_minus_one*/) const { return p; }

  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& /*change*/,
                           const T& q) const {
    return (V * q) * deformation_cofactor(H);
  }

  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& /*H*/, const VolumeChange<T>& change,
                               const T& q) const {
    return (V * q * (T(1) + change.J_minus_one)) * identity<T>();
  }
};

}  // namespace sandglass
