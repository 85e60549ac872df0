#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

#include "base/type_list.hpp"
#include "material/elastic_laws.hpp"
#include "material/material_axes.hpp"
#include "material/point_load.hpp"
#include "material/tangent_bound.hpp"
#include "material/volumetric_parts.hpp"
#include "math/pack.hpp"

namespace sandglass {

template <class T, class Law>
class OrientedLaw;

/// An elastic law and its volumetric part behind function calls. Kernels are compiled once for all laws that
/// they call, and laws once for all kernels: the cost of a build is methods + laws, not methods x laws. A
/// call handles as many elements as a register holds, and all their integration points. The functions
/// declared here are the law's, in material axes (null: the axes of space). `Value` is the type of its
/// numbers, see ElasticLawsOf. `called_law_functions.hpp` defines them; the library instantiates them for the
/// number types of its kernels, see CMakeLists.txt.
template <class Value>
class CalledLawOf : public SumOfParts<CalledLawOf<Value>> {
 public:
  static constexpr LawTraits traits{.isotropic = false};  // known at run time

  template <class Law>
  explicit CalledLawOf(const Law& law, VolumetricPart volume = {})
      : law_(law), volume_(volume), shear_modulus_(law.shear_modulus()), bulk_modulus_(law.bulk_modulus()) {}

  /// The laws of several bodies, which are of one kind and have one volumetric part, as one law with the
  /// numbers of each in its lane.
  explicit CalledLawOf(std::span<const CalledLawOf<double>> bodies) : CalledLawOf(beside(bodies)) {}

  Value shear_modulus() const { return shear_modulus_; }
  Value bulk_modulus() const { return bulk_modulus_; }

  /// The law in elements with these axes.
  template <class T>
  OrientedLaw<T, CalledLawOf> with_axes(const MaterialAxes<T>* axes) const;

  /// The volumetric energy (J/m^3), its derivative by J (Pa), and the second (Pa).
  template <class T>
  T volumetric_energy(const T& J_minus_one) const {
    if (quadratic()) return T(0.5 * bulk_modulus_) * J_minus_one * J_minus_one;
    return called_volume(J_minus_one).energy;
  }
  template <class T>
  T pressure(const T& J_minus_one) const {
    if (quadratic()) return T(bulk_modulus_) * J_minus_one;
    return called_volume(J_minus_one).slope;
  }
  /// The pressure minus K (J - 1), Pa.
  template <class T>
  T pressure_beyond_quadratic(const T& J_minus_one) const {
    if (quadratic()) return T(0);
    return called_volume(J_minus_one).slope - T(bulk_modulus_) * J_minus_one;
  }
  template <class T>
  T bulk_tangent(const T& J_minus_one) const {
    if (quadratic()) return T(bulk_modulus_);
    return called_volume(J_minus_one).curvature;
  }

  /// The isochoric strain energy density, J/m^3.
  template <class T>
  T isochoric_energy(const Tensor<T>& H, const MaterialAxes<T>* axes = nullptr) const;

  /// V P (Pa m^3) at `count` points.
  template <class T>
  void weighted_piola(std::size_t count, const PointLoad<T>* at, const Tensor<T>* H, Tensor<T>* VP,
                      const MaterialAxes<T>* axes = nullptr) const;

  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& change, const T& p,
                           const MaterialAxes<T>* axes = nullptr) const {
    const PointLoad<T> at{V, change, p};
    Tensor<T> VP;
    weighted_piola(1, &at, &H, &VP, axes);
    return VP;
  }

  /// V tau (Pa m^3) at a point.
  template <class T>
  void weighted_kirchhoff(const PointLoad<T>* at, const Tensor<T>* H, Tensor<T>* V_tau,
                          const MaterialAxes<T>* axes) const;

  template <class T>
  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H, const VolumeChange<T>& change, const T& p,
                               const MaterialAxes<T>* axes = nullptr) const {
    const PointLoad<T> at{V, change, p};
    Tensor<T> V_tau;
    weighted_kirchhoff(&at, &H, &V_tau, axes);
    return V_tau;
  }

  /// The bound with a pressure p (Pa) and a bulk tangent (Pa) that need not be the law's own.
  template <class T>
  TangentBound<T> tangent_bound(const Tensor<T>& H, const T& J_minus_one, const T& p, const T& bulk,
                                const MaterialAxes<T>* axes = nullptr) const;

  /// The same for the elastic law of a viscoelastic one; see `viscoelastic_tangent_bound`.
  template <class T>
  TangentBound<T> viscoelastic_tangent_bound(const Tensor<T>& H, const T& J_minus_one, const T& p,
                                             const T& bulk, const MaterialAxes<T>* axes = nullptr) const;

  /// The stress (Pa) of a small strain.
  template <class T>
  Tensor<T> small_strain_stress(const Tensor<T>& strain, const MaterialAxes<T>* axes = nullptr) const;

 private:
  template <class>
  friend class CalledLawOf;

  static CalledLawOf beside(std::span<const CalledLawOf<double>> bodies) {
    const auto of_kind = [&]<template <class> class LawOf>(const LawOf<double>& /*first*/) {
      LawOf<Value> all;
      for (int lane = 0; lane < Lanes<Value>::width; ++lane) {
        const auto& own = std::get<LawOf<double>>(bodies[static_cast<std::size_t>(lane)].law_);
        const auto set = [&](const auto& here, const auto& there) {
          Lanes<Value>::set(all.*here.member, lane, own.*there.member);
        };
        std::apply(
            [&](const auto&... here) {
              std::apply([&](const auto&... there) { (set(here, there), ...); }, LawOf<double>::parameters());
            },
            LawOf<Value>::parameters());
      }
      return CalledLawOf(all, bodies.front().volume_);
    };
    return std::visit(of_kind, bodies.front().law_);
  }

  /// A volumetric energy (J/m^3) and its derivatives by J (Pa).
  template <class T>
  struct Volume {
    T energy;
    T slope;
    T curvature;
  };

  bool quadratic() const { return std::holds_alternative<QuadraticPart>(volume_); }

  template <class T>
  Volume<T> called_volume(const T& J_minus_one) const;

  template <std::size_t alternative, class Visit>
  decltype(auto) visit(const Visit& visit) const;

  VariantOf<ElasticLawsOf<Value>> law_;
  VolumetricPart volume_;
  Value shear_modulus_;
  Value bulk_modulus_;
};

using CalledLaw = CalledLawOf<double>;

/// A called law in elements with material axes, T holding one element in each lane.
template <class T, class Law>
class OrientedLaw : public VolumeOfElastic<OrientedLaw<T, Law>> {
 public:
  static constexpr LawTraits traits = Law::traits;

  OrientedLaw(const Law& law, const MaterialAxes<T>* axes) : law_(law), axes_(axes) {}

  const Law& elastic() const { return law_; }

  template <class U>
  U isochoric_energy(const Tensor<U>& H) const {
    return law_.isochoric_energy(H, Axes<U>(axes_).pointer());
  }
  template <class U>
  void weighted_piola(std::size_t count, const PointLoad<U>* at, const Tensor<U>* H, Tensor<U>* VP) const {
    law_.weighted_piola(count, at, H, VP, Axes<U>(axes_).pointer());
  }
  template <class U>
  Tensor<U> weighted_piola(const U& V, const Tensor<U>& H, const VolumeChange<U>& change, const U& p) const {
    return law_.weighted_piola(V, H, change, p, Axes<U>(axes_).pointer());
  }
  template <class U>
  Tensor<U> weighted_kirchhoff(const U& V, const Tensor<U>& H, const VolumeChange<U>& change,
                               const U& p) const {
    return law_.weighted_kirchhoff(V, H, change, p, Axes<U>(axes_).pointer());
  }
  template <class U>
  TangentBound<U> tangent_bound(const Tensor<U>& H, const U& J_minus_one, const U& p, const U& bulk) const {
    return law_.tangent_bound(H, J_minus_one, p, bulk, Axes<U>(axes_).pointer());
  }
  template <class U>
  TangentBound<U> viscoelastic_tangent_bound(const Tensor<U>& H, const U& J_minus_one, const U& p,
                                             const U& bulk) const {
    return law_.viscoelastic_tangent_bound(H, J_minus_one, p, bulk, Axes<U>(axes_).pointer());
  }
  template <class U>
  Tensor<U> small_strain_stress(const Tensor<U>& strain) const {
    return law_.small_strain_stress(strain, Axes<U>(axes_).pointer());
  }

 private:
  /// The axes as another number type: set-up takes derivatives in dual numbers.
  template <class U>
  class Axes {
   public:
    explicit Axes(const MaterialAxes<T>* axes) {
      if (axes != nullptr) converted_ = from_double<U>(*axes);
      given_ = axes != nullptr;
    }
    const MaterialAxes<U>* pointer() const { return given_ ? &converted_ : nullptr; }

   private:
    MaterialAxes<U> converted_;
    bool given_;
  };
  template <class U>
  requires std::is_same_v<T, U>
  class Axes<U> {
   public:
    explicit Axes(const MaterialAxes<T>* axes) : axes_(axes) {}
    const MaterialAxes<U>* pointer() const { return axes_; }

   private:
    const MaterialAxes<T>* axes_;
  };

  const Law& law_;
  const MaterialAxes<T>* axes_;
};

template <class Value>
template <class T>
OrientedLaw<T, CalledLawOf<Value>> CalledLawOf<Value>::with_axes(const MaterialAxes<T>* axes) const {
  return {*this, axes};
}

}  // namespace sandglass
