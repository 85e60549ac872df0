#pragma once

#include "element/one_point.hpp"

/// OnePoint with its geometry h, c and V held in other forms. Forces are the same up to roundoff.
namespace sandglass {

/// The functions that do not run in every step: OnePoint with the geometry of `Form::geometry(motion,
/// element)`.
template <class Form>
struct OnePointForm {
  template <class Hourglass, class T, class Element, class Law>
  static ElementEnergy<T> energy(const ElementMotion<T>& motion, const Element& element,
                                 const typename Hourglass::template Element<T>& control,
                                 const NoHistory<T>& history, const Law& law) {
    return OnePoint::energy<Hourglass>(motion, Form::geometry(motion, element), control, history, law);
  }

  template <class T, class Element>
  static T volume(const ElementMotion<T>& motion, const Element& element) {
    return Form::geometry(motion, element).V;
  }

  template <class T, class Element>
  static T dilatation(const ElementMotion<T>& motion, const Element& element) {
    return OnePoint::dilatation(motion, Form::geometry(motion, element));
  }

  template <class Hourglass, class T, class Element, class Law>
  static T stiffness_bound(const ElementMotion<T>& motion, const Element& element,
                           const typename Hourglass::template Element<T>& control,
                           const NoHistory<T>& history, const Law& law) {
    return OnePoint::stiffness_bound<Hourglass>(motion, Form::geometry(motion, element), control, history,
                                                law);
  }
};

/// OnePoint that loads only coordinates and recomputes its geometry in every step, which saves time if memory
/// is slower than arithmetic.
struct CompactOnePoint : OnePointForm<CompactOnePoint> {
  static constexpr KinematicsTraits traits{.needs_coordinates = true};

  /// Nothing constant in time is stored.
  template <class T>
  struct Element {};

  static Element<double> precompute(const NodalVectors<double>& /*X*/) { return {}; }

  template <class T>
  static OnePoint::Element<T> geometry(const ElementMotion<T>& motion, const Element<T>& /*element*/) {
    return OnePoint::geometry(motion.X);
  }

  template <class T>
  struct Deformation {
    OnePoint::Element<T> geometry;
    OnePoint::Deformation<T> now;
  };

  template <class Hourglass, class T>
  static Deformation<T> deformation(const ElementMotion<T>& motion, const Element<T>& element) {
    Deformation<T> result;
    result.geometry = geometry(motion, element);
    result.now = OnePoint::deformation<Hourglass>(motion, result.geometry);
    return result;
  }

  template <class Hourglass, class T, class Law>
  static Modes<T> force(const Deformation<T>& deformation, const Element<T>& /*element*/,
                        const typename Hourglass::template Element<T>& control, NoHistory<T>& history,
                        const Law& law) {
    return OnePoint::force<Hourglass>(deformation.now, deformation.geometry, control, history, law);
  }
};

/// OnePoint on parallelepipeds: c = 0, the gradients of the hourglass modes are zero, gamma = Gamma and
/// q = Gamma^T u. Only for controls that do not follow the deformation.
struct ParallelepipedOnePoint : OnePointForm<ParallelepipedOnePoint> {
  static constexpr KinematicsTraits traits{};

  template <class T>
  struct Element {
    Tensor<T> h;  ///< mean gradients of the modes xi, eta and zeta, 1/m
    T V;          ///< reference volume, m^3
  };
  template <class T>
  using Deformation = OnePoint::Deformation<T>;

  static Element<double> precompute(const NodalVectors<double>& X) {
    const auto geometry = OnePoint::precompute(X);
    Element<double> element{{}, geometry.V};
    std::copy_n(geometry.h.entries.begin(), 9, element.h.entries.begin());
    return element;
  }

  template <class T>
  static OnePoint::Element<T> geometry(const ElementMotion<T>& /*motion*/, const Element<T>& element) {
    OnePoint::Element<T> geometry{};
    std::copy_n(element.h.entries.begin(), 9, geometry.h.entries.begin());
    geometry.V = element.V;
    return geometry;
  }

  template <class Hourglass, class T>
  static Deformation<T> deformation(const ElementMotion<T>& motion, const Element<T>& element) {
    Deformation<T> now;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        now.H(i, j) = motion.u(0, i) * element.h(0, j) + motion.u(1, i) * element.h(1, j) +
                      motion.u(2, i) * element.h(2, j);
      }
      for (int a = 0; a < 4; ++a) now.q(a, i) = motion.u(3 + a, i);
    }
    now.change = volume_change(now.H);
    return now;
  }

  template <class Hourglass, class T, class Law>
  static Modes<T> force(const Deformation<T>& now, const Element<T>& element,
                        const typename Hourglass::template Element<T>& control, NoHistory<T>& /*history*/,
                        const Law& law) {
    static_assert(!FollowsDeformation<Hourglass>);
    const T p = law.pressure(now.change.J_minus_one);
    const Tensor<T> hS = element.h * transpose(law.weighted_piola(element.V, now.H, now.change, p));
    HourglassModes<T> Q{};
    if constexpr (Hourglass::traits.active) Q = Hourglass::resistance(now.q, control);
    Modes<T> f;
    for (int i = 0; i < 3; ++i) {
      for (int m = 0; m < 3; ++m) f(m, i) = hS(m, i);
      for (int a = 0; a < 4; ++a) f(3 + a, i) = Q(a, i);
    }
    return f;
  }
};

}  // namespace sandglass
