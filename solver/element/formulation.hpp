#pragma once

#include "element/hourglass_settings.hpp"
#include "element/one_point.hpp"

namespace sandglass {

/// An element: kinematics (how stress becomes force), an hourglass control and a material law, bundled.
/// All functions are templated on the number type T: double, a pack, a counting or a dual number.
template <class Kinematics, class Hourglass, class Law>
struct Formulation {
  /// What is constant in time.
  template <class T>
  struct Element {
    typename Kinematics::template Element<T> body;
    [[no_unique_address]] typename Hourglass::template Element<T> hourglass;
  };

  /// The constants of an element with reference coordinates X (m).
  static Element<double> precompute(const NodalVectors<double>& X, const Law& law,
                                    const HourglassSettings& settings) {
    return {Kinematics::precompute(X), Hourglass::precompute(X, law, settings)};
  }

  /// Internal nodal forces (N) at the nodal displacements u (m): the derivative of the energy with respect to
  /// u.
  template <class T>
  static NodalVectors<T> force(const NodalVectors<T>& u, const Element<T>& element, const Law& law) {
    return Kinematics::template force<Hourglass>(u, element.body, element.hourglass, law);
  }

  /// Strain and hourglass energy (J).
  template <class T>
  static ElementEnergy<T> energy(const NodalVectors<T>& u, const Element<T>& element, const Law& law) {
    return Kinematics::template energy<Hourglass>(u, element.body, element.hourglass, law);
  }

  /// The smallest det F at the integration points.
  template <class T>
  static T smallest_jacobian(const NodalVectors<T>& u, const Element<T>& element) {
    return Kinematics::smallest_jacobian(u, element.body);
  }

  /// The volume ratio of the element.
  template <class T>
  static T mean_jacobian(const NodalVectors<T>& u, const Element<T>& element) {
    return Kinematics::mean_jacobian(u, element.body);
  }

  /// An upper bound of the largest eigenvalue (N/m) of the tangent stiffness at u, hourglass part included.
  template <class T>
  static T stiffness_bound(const NodalVectors<T>& u, const Element<T>& element, const Law& law) {
    return Kinematics::template stiffness_bound<Hourglass>(u, element.body, element.hourglass, law);
  }
};

}  // namespace sandglass
