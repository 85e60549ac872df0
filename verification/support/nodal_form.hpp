#pragma once

#include "element/formulation.hpp"

namespace sandglass::verification {

/// A single element without history, from nodal displacements u (m) to nodal forces (N): the kernel's
/// functions without modes.
template <class Kernel>
struct NodalForm : Kernel {
  static_assert(!Kernel::remembers && !Kernel::needs_increment && !Kernel::needs_coordinates &&
                !Kernel::averages_over_nodes);

  template <class T, class Element, class Law>
  static NodalVectors<T> force(const NodalVectors<T>& u, const Element& element, const Law& law) {
    typename Kernel::template History<T> none;
    return from_modes(Kernel::force(Kernel::deformation(motion(u), element), element, none, law));
  }

  template <class T, class Element, class Law>
  static ElementEnergy<T> energy(const NodalVectors<T>& u, const Element& element, const Law& law) {
    return Kernel::energy(motion(u), element, typename Kernel::template History<T>{}, law);
  }

  template <class T, class Element>
  static T smallest_jacobian(const NodalVectors<T>& u, const Element& element) {
    return Kernel::smallest_jacobian(motion(u), element);
  }

  template <class T, class Element>
  static T mean_jacobian(const NodalVectors<T>& u, const Element& element) {
    return Kernel::mean_jacobian(motion(u), element);
  }

  template <class T, class Element, class Law>
  static T stiffness_bound(const NodalVectors<T>& u, const Element& element, const Law& law) {
    return Kernel::stiffness_bound(motion(u), element, typename Kernel::template History<T>{}, law);
  }

 private:
  template <class T>
  static ElementMotion<T> motion(const NodalVectors<T>& u) {
    return {.u = to_modes(u), .increment = {}, .X = {}, .inverse_step = T(0), .dilatation = {}};
  }
};

}  // namespace sandglass::verification
