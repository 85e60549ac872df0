#pragma once

#include "element/modes.hpp"

namespace sandglass {

/// A control that follows the mean deformation says so with `follows_deformation = true`. Its energy depends
/// on the hourglass displacements q = gamma^T u and on the mean displacement gradient H, and it gives
///   response(q, H, control)                  both derivatives of the energy,
///   energy(q, H, control)                    the energy itself, J,
///   stiffness_bound(gamma, h, q, H, control) a bound of its part of the tangent, N/m,
/// where a control that does not follow gives resistance(q, control), energy(q, control) and
/// stiffness_bound(gamma, control), and costs nothing more.
template <class Hourglass>
concept FollowsDeformation = requires {
  requires Hourglass::follows_deformation;
};

/// Derivatives of the energy E(q, H) of a control that follows the mean deformation. Both have to reach the
/// nodes: with Q alone forces would follow from no energy, and turn the element about itself.
template <class T>
struct HourglassResponse {
  HourglassModes<T> Q;  ///< dE/dq_ai, N
  Tensor<T> S;          ///< dE/dH_ij in row j and column i, J: what the control adds to V P^T
};

}  // namespace sandglass
