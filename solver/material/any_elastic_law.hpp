#pragma once

#include <variant>

#include "base/type_list.hpp"
#include "material/quadratic_volume.hpp"
#include "material/small_strain.hpp"
#include "material/tangent_bound.hpp"

namespace sandglass {

/// One of a list of elastic laws, as a law: which one is decided at each call. The kernels of elastic laws
/// know their law when they are compiled; those of wrapped laws are compiled once for all of them, which
/// costs them a few nanoseconds per call, and a call is for as many elements as a register holds.
template <class List>
class AnyElasticLaw : public QuadraticVolume<AnyElasticLaw<List>> {
 public:
  template <class Law>
  explicit AnyElasticLaw(const Law& law)
      : law_(law), shear_modulus_(law.shear_modulus()), bulk_modulus_(law.bulk_modulus()) {}

  double shear_modulus() const { return shear_modulus_; }
  double bulk_modulus() const { return bulk_modulus_; }

  // The functions below are those of the law. Kept out of line, they are compiled once and not in every
  // kernel.

  template <class T>
  [[gnu::noinline]] T isochoric_energy(const Tensor<T>& H) const {
    return std::visit([&](const auto& law) { return law.isochoric_energy(H); }, law_);
  }

  template <class T>
  [[gnu::noinline]] Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                                             const T& p) const {
    return std::visit([&](const auto& law) { return law.weighted_piola(V, H, change, p); }, law_);
  }

  template <class T>
  [[gnu::noinline]] Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H,
                                                 const VolumeChange<T>& change, const T& p) const {
    return std::visit([&](const auto& law) { return law.weighted_kirchhoff(V, H, change, p); }, law_);
  }

  /// The bound of the whole: not every law of the list has one of its isochoric part.
  template <class T>
  [[gnu::noinline]] TangentBound<T> tangent_bound(const Tensor<T>& H) const {
    return std::visit([&](const auto& law) { return sandglass::tangent_bound(law, H); }, law_);
  }

  template <class T>
  Tensor<T> small_strain_stress(const Tensor<T>& strain) const {
    return std::visit([&](const auto& law) { return sandglass::small_strain_stress(law, strain); }, law_);
  }

 private:
  VariantOf<List> law_;
  double shear_modulus_;
  double bulk_modulus_;
};

}  // namespace sandglass
