#pragma once

#include "element/one_point.hpp"

namespace sandglass {

/// OnePoint that loads only coordinates and recomputes its geometry in every step, which saves time where
/// memory is slower than arithmetic. Forces are the same up to roundoff.
struct CompactOnePoint {
  static constexpr bool needs_increment = false;
  static constexpr bool needs_coordinates = true;

  /// What is constant in time: nothing that is stored.
  template <class T>
  struct Element {};

  static Element<double> precompute(const NodalVectors<double>& /*X*/) { return {}; }

  template <class T>
  struct Deformation {
    OnePoint::Element<T> geometry;
    OnePoint::Deformation<T> now;
  };

  template <class Hourglass, class T>
  static Deformation<T> deformation(const ElementMotion<T>& motion, const Element<T>& /*element*/) {
    Deformation<T> result;
    result.geometry = OnePoint::geometry(motion.X);
    result.now = OnePoint::deformation<Hourglass>(motion, result.geometry);
    return result;
  }

  template <class Hourglass, class T, class Law>
  static Modes<T> force(const Deformation<T>& deformation, const Element<T>& /*element*/,
                        const typename Hourglass::template Element<T>& control, NoHistory<T>& history,
                        const Law& law) {
    return OnePoint::force<Hourglass>(deformation.now, deformation.geometry, control, history, law);
  }

  template <class Hourglass, class T, class Law>
  static ElementEnergy<T> energy(const ElementMotion<T>& motion, const Element<T>& /*element*/,
                                 const typename Hourglass::template Element<T>& control,
                                 const NoHistory<T>& history, const Law& law) {
    return OnePoint::energy<Hourglass>(motion, OnePoint::geometry(motion.X), control, history, law);
  }

  template <class T>
  static T volume(const ElementMotion<T>& motion, const Element<T>& /*element*/) {
    return OnePoint::geometry(motion.X).V;
  }

  template <class T>
  static T smallest_jacobian(const ElementMotion<T>& motion, const Element<T>& /*element*/) {
    return OnePoint::smallest_jacobian(motion, OnePoint::geometry(motion.X));
  }

  template <class T>
  static T dilatation(const ElementMotion<T>& motion, const Element<T>& /*element*/) {
    return OnePoint::dilatation(motion, OnePoint::geometry(motion.X));
  }

  template <class Hourglass, class T, class Law>
  static T stiffness_bound(const ElementMotion<T>& motion, const Element<T>& /*element*/,
                           const typename Hourglass::template Element<T>& control,
                           const NoHistory<T>& history, const Law& law) {
    return OnePoint::stiffness_bound<Hourglass>(motion, OnePoint::geometry(motion.X), control, history, law);
  }
};

}  // namespace sandglass
