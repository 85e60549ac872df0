#pragma once

#include <optional>

#include "problem/case.hpp"

namespace sandglass {

/// The velocities that a case gives to a set of nodes at the start.
class InitialMotion {
 public:
  /// Nodes `nodes` of `points` (m) with lumped `masses` (kg); not empty.
  InitialMotion(const InitialVelocity& velocity, const NodalField& points, const std::vector<double>& masses,
                const std::vector<int>& nodes);

  /// An axis with half waves on which the nodes have no extent.
  std::optional<std::size_t> axis_without_extent() const;

  /// The velocity (m/s) at X (m): value, as a wave where there is one, and spin x (X - centre of mass).
  Vector at(const Vector& X) const;

 private:
  InitialVelocity velocity_;
  Vector low_{};
  Vector high_{};
  Vector centre_{};
};

}  // namespace sandglass
