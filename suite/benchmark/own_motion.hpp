#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmark/measure.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// The time in which a shear wave crosses a scene's body, s; the slowest wave where materials differ.
double crossing_time(const Scene& scene);

/// The scene in motion: of a dynamic case the scene itself; of a quasi-static one the damped motion to its
/// whole load, over `own_motion_crossings` crossing times. A program that follows the same scene step by step
/// takes such a motion.
Scene in_own_motion(const Scene& scene);

/// Crossing times of the damped motion of a quasi-static case, over all of which its load grows: slow enough
/// that the body stays near its equilibria, and that mean steps are within 2 % of those of a slower motion.
inline constexpr double own_motion_crossings = 3.5;

/// The damping of this motion times the crossing time. Other programs are measured with the same
/// (exchange/decks/problem.py).
inline constexpr double own_motion_damping = 2.0;

/// States of a motion in which steps are timed where they do not all cost the same.
inline constexpr std::size_t levels_on_the_way = 8;

/// What a method's steps were in a motion.
struct OwnMotion {
  std::optional<double> mean_step = {};  ///< s: simulated time over the number of steps; none: it fails
  std::string remark = {};  ///< why it fails, or of states that need far shorter steps; mostly empty
  NodalField end = {};      ///< displacements (m) at its end, empty if it fails
  /// Of a method that adapts, the levels of its elements amid `levels_on_the_way` equal numbers of steps.
  std::vector<std::vector<double>> levels = {};
  double adaption = 0.0;  ///< s, of the choice of levels, shared out over the steps
};

/// Follows a scene's own motion with a method on one thread, in float, or, with a method that adapts, in
/// double. A motion that fails, or whose steps shrink until it would take a hundred times as many as at rest,
/// has no mean step, but a remark. Throws ComputationError when told to end, InputError for a method that
/// takes no steps.
OwnMotion follow_own_motion(const Scene& scene, MethodChoice choice, const Proceed& proceed);

}  // namespace sandglass
