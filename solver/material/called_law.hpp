#pragma once

#include <array>
#include <cstddef>

#include "base/type_list.hpp"
#include "material/elastic_laws.hpp"
#include "material/point_load.hpp"
#include "material/quadratic_volume.hpp"
#include "material/tangent_bound.hpp"

namespace sandglass {

/// An elastic law behind function calls. Kernels are compiled once for all laws that they call, and laws once
/// for all kernels: the cost of a build is methods + laws, not methods x laws. A call handles as many
/// elements as a register holds, and all their integration points.
///
/// The functions declared here are those of the law. `called_law_functions.hpp` defines them; the library
/// instantiates them for the number types of its kernels, see CMakeLists.txt.
class CalledLaw : public QuadraticVolume<CalledLaw> {
 public:
  template <class Law>
  explicit CalledLaw(const Law& law)
      : law_(law), shear_modulus_(law.shear_modulus()), bulk_modulus_(law.bulk_modulus()) {}

  double shear_modulus() const { return shear_modulus_; }
  double bulk_modulus() const { return bulk_modulus_; }

  /// The isochoric strain energy density, J/m^3.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const;

  /// V P (Pa m^3) at `count` points.
  template <class T>
  void weighted_piola(std::size_t count, const PointLoad<T>* at, const Tensor<T>* H, Tensor<T>* VP) const;

  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& change, const T& p) const {
    const PointLoad<T> at{V, change, p};
    Tensor<T> VP;
    weighted_piola(1, &at, &H, &VP);
    return VP;
  }

  /// V tau (Pa m^3) at a point.
  template <class T>
  void weighted_kirchhoff(const PointLoad<T>* at, const Tensor<T>* H, Tensor<T>* V_tau) const;

  template <class T>
  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                               const T& p) const {
    const PointLoad<T> at{V, change, p};
    Tensor<T> V_tau;
    weighted_kirchhoff(&at, &H, &V_tau);
    return V_tau;
  }

  /// The bound with a pressure p (Pa) and a bulk tangent (Pa) that need not be the law's own.
  template <class T>
  TangentBound<T> tangent_bound(const Tensor<T>& H, const T& J_minus_one, const T& p, const T& bulk) const;

  /// The same for the elastic law of a viscoelastic one; see `viscoelastic_tangent_bound`.
  template <class T>
  TangentBound<T> viscoelastic_tangent_bound(const Tensor<T>& H, const T& J_minus_one, const T& p,
                                             const T& bulk) const;

  /// The stress (Pa) of a small strain.
  template <class T>
  Tensor<T> small_strain_stress(const Tensor<T>& strain) const;

 private:
  template <std::size_t alternative, class Visit>
  decltype(auto) visit(const Visit& visit) const;

  VariantOf<ElasticLaws> law_;
  double shear_modulus_;
  double bulk_modulus_;
};

}  // namespace sandglass
