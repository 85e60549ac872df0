#pragma once

#include "element/hourglass_settings.hpp"
#include "math/matrix.hpp"

namespace sandglass {

/// An element: kinematics (how stress becomes force), an hourglass control and a material law, bundled.
/// All functions are templated on the number type T: double, a pack, a counting or a dual number.
template <class Kinematics, class Hourglass, class Law>
struct Formulation {
  /// What is constant in time.
  template <class T>
  struct Element {
    typename Kinematics::template Element<T> body;
    typename Hourglass::template Element<T> hourglass;
  };

  /// Energies of one element, in J.
  template <class T>
  struct Energy {
    T strain;
    T hourglass;
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
    const Tensor<T> H = Kinematics::mean_gradient(u, element.body);
    return Kinematics::force(u, H, element.body, law) + Hourglass::force(u, H, element.hourglass);
  }

  template <class T>
  static Energy<T> energy(const NodalVectors<T>& u, const Element<T>& element, const Law& law) {
    const Tensor<T> H = Kinematics::mean_gradient(u, element.body);
    return {Kinematics::energy(u, H, element.body, law), Hourglass::energy(u, H, element.hourglass)};
  }

  /// The smallest det F at the integration points.
  template <class T>
  static T smallest_jacobian(const NodalVectors<T>& u, const Element<T>& element) {
    return Kinematics::smallest_jacobian(u, Kinematics::mean_gradient(u, element.body), element.body);
  }

  /// The volume ratio of the element.
  template <class T>
  static T mean_jacobian(const NodalVectors<T>& u, const Element<T>& element) {
    return Kinematics::mean_jacobian(u, Kinematics::mean_gradient(u, element.body), element.body);
  }

  /// An upper bound of the largest eigenvalue (N/m) of the tangent stiffness at u, hourglass part included.
  template <class T>
  static T stiffness_bound(const NodalVectors<T>& u, const Element<T>& element, const Law& law) {
    const Tensor<T> H = Kinematics::mean_gradient(u, element.body);
    return Kinematics::stiffness_bound(u, H, element.body, law) +
           Hourglass::stiffness_bound(element.hourglass);
  }
};

}  // namespace sandglass
