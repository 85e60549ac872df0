#pragma once

#include "element/one_point.hpp"
#include "material/small_strain.hpp"

namespace sandglass {

/// factor * sym(H): the small strain of a displacement gradient, times a factor.
template <class T>
Tensor<T> weighted_strain(const T& factor, const Tensor<T>& H) {
  const T half = T(0.5) * factor;
  Tensor<T> e;
  for (int i = 0; i < 3; ++i) {
    e(i, i) = factor * H(i, i);
    for (int j = i + 1; j < 3; ++j) {
      e(i, j) = half * (H(i, j) + H(j, i));
      e(j, i) = e(i, j);
    }
  }
  return e;
}

/// The small-strain limit of a law, with the interface of a law: stresses are linear in H and ignore
/// rotation.
template <class Law>
class SmallStrainLaw {
 public:
  explicit SmallStrainLaw(const Law& law) : law_(law) {}

  /// Zero: the stress below is the total one.
  template <class T>
  T pressure(const T& /*J_minus_one*/) const {
    return T(0);
  }

  /// V sigma, with V on the strain: six products instead of nine.
  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& /*change*/,
                           const T& /*p*/) const {
    return small_strain_stress(law_, weighted_strain(V, H));
  }

  /// sigma : e / 2, in J/m^3.
  template <class T>
  T energy(const Tensor<T>& H) const {
    const Tensor<T> e = weighted_strain(T(1), H);
    return T(0.5) * double_dot(small_strain_stress(law_, e), e);
  }

 private:
  const Law& law_;
};

/// The uniform strain hexahedron of small-strain elasticity: f = K u with a constant, symmetric K. It is
/// OnePoint with the law replaced by its undeformed tangent, and correct to first order in displacement
/// gradients; a finite rotation causes a spurious strain of 1 - cos(angle). This is the model of surgery
/// simulators that superpose or condense responses (Bro-Nielsen and Cotin 1996). Small-strain theory itself
/// never fails and would silently return inverted elements, which are as impossible as with any other method;
/// det(I + H) detects them.
struct LinearOnePoint : OnePoint {
  static constexpr KinematicsTraits traits{.small_strain = true};

  /// As in OnePoint, without the change of volume, which small strains do not need.
  template <class Hourglass, class T>
  static Deformation<T> deformation(const ElementMotion<T>& motion, const Element<T>& element) {
    Deformation<T> now;
    now.H = OnePoint::mean_gradient(motion.u, element);
    now.change = {T(0), T(1)};
    if constexpr (Hourglass::traits.active) {
      now.q = OnePoint::hourglass_displacements(motion.u, now.H, element);
    }
    return now;
  }

  template <class Hourglass, class T, class Law>
  static Modes<T> force(const Deformation<T>& now, const Element<T>& element,
                        const typename Hourglass::template Element<T>& control, NoHistory<T>& history,
                        const Law& law) {
    return OnePoint::force<Hourglass>(now, element, control, history, SmallStrainLaw<Law>(law));
  }

  template <class Hourglass, class T, class Law>
  static ElementEnergy<T> energy(const ElementMotion<T>& motion, const Element<T>& element,
                                 const typename Hourglass::template Element<T>& control,
                                 const NoHistory<T>& history, const Law& law) {
    return OnePoint::energy<Hourglass>(motion, element, control, history, SmallStrainLaw<Law>(law));
  }

  /// The bound (N/m) of the undeformed OnePoint for all displacements: the stiffness is constant.
  template <class Hourglass, class T, class Law>
  static T stiffness_bound(const ElementMotion<T>& motion, const Element<T>& element,
                           const typename Hourglass::template Element<T>& control,
                           const NoHistory<T>& history, const Law& law) {
    ElementMotion<T> undeformed = motion;
    undeformed.u = {};
    return OnePoint::stiffness_bound<Hourglass>(undeformed, element, control, history, law);
  }
};

}  // namespace sandglass
