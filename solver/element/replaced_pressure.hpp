#pragma once

#include "element/hourglass_none.hpp"
#include "element/linear_one_point.hpp"
#include "element/method_traits.hpp"
#include "material/called_law.hpp"
#include "material/given_pressure.hpp"

namespace sandglass {

/// The part of InternalForce::replace_pressures of one element: the forces (N) in modes, and V (q(J) - p) /
/// lambda (m^3).
template <class T>
struct ReplacedPressure {
  Modes<T> force;
  T defect;
};

/// The same for a pressure p (Pa); `lambda` (Pa) and its inverse are those of the law.
template <class Method, class T>
ReplacedPressure<T> replace_pressure(const ElementMotion<T>& motion,
                                     const typename Method::Kinematics::template Element<T>& body, const T& p,
                                     const T& lambda, const T& compliance, const CalledLaw& law) {
  using Kinematics = typename Method::Kinematics;
  const T V = Kinematics::volume(motion, body);
  if constexpr (is_linear<Method>) {
    const Tensor<T> H = OnePoint::mean_gradient(motion.u, body);
    const T dilatation = H(0, 0) + H(1, 1) + H(2, 2);
    return {OnePoint::body_forces((V * (p - lambda * dilatation)) * identity<T>(), body),
            V * (dilatation - compliance * p)};
  } else {
    const T dilatation = Kinematics::dilatation(motion, body);
    const T beyond = law.pressure_beyond_quadratic(dilatation);
    const NoHourglassControl::Element<T> control{};
    NoHistory<T> none;
    const auto now = Kinematics::template deformation<NoHourglassControl>(motion, body);
    return {Kinematics::template force<NoHourglassControl>(
                now, body, control, none, GivenPressure<T>{(p - beyond) - lambda * dilatation}),
            V * (dilatation + compliance * (beyond - p))};
  }
}

}  // namespace sandglass
