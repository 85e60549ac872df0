#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "problem/model.hpp"

namespace sandglass {

/// The stable step of a mesh.
struct StableStep {
  static constexpr int by_damping = -2;

  double step;  ///< s
  int element;  ///< the element that determines it, or `by_damping`
};

/// The stable step with mass-proportional damping (1/s), at most 1 / damping: with longer steps, velocities
/// would overshoot; beyond 2 / damping they would change their sign.
inline StableStep damped(const StableStep& stable, double damping) {
  if (damping * stable.step <= 1.0) return stable;
  return {1.0 / damping, StableStep::by_damping};
}

/// 2 / omega_max (s) of each element from bounds of their stiffness (N/m), with omega_max^2 <= bound / (rho V
/// / 8) and what springs and pressures add. The largest frequency of a mesh is at most the largest of its
/// elements, so that the smallest of these steps is stable. Dashpots c, which act half a step late, shorten
/// it: omega^2 dt^2 + 2 c/m dt <= 4.
std::vector<double> stable_steps(const Model& model, std::vector<double> stiffness_bounds);

/// The smallest of them.
StableStep stable_step(const Model& model, std::span<const double> stiffness_bounds);

/// The same at displacements u (m).
StableStep stable_step(const Model& model, const NodalField& u);

/// Throws ComputationError if a step has collapsed to less than a thousandth of the undeformed body's: a
/// single element shortens the steps of the whole body, and the motion would not end. `time` (s) and `step`
/// are the current ones; `part` names the thing that `stable.element` counts.
void require_worthwhile(const StableStep& stable, double undeformed_step, double time, long step,
                        std::string_view part = "element");

/// The stable step (s) of a body, given the largest squared frequency (1/s^2) of its elements.
double stable_step_of(const Model& model, double square);

}  // namespace sandglass
