#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/measure.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// The time (s) in which a shear wave crosses a scene's body; the slowest wave if materials differ.
double crossing_time(const Scene& scene);

/// The scene in motion: a dynamic case as it is; a quasi-static one as a damped motion, during which the load
/// grows to its full value in `own_motion_crossings` crossing times, as in a program that computes the scene
/// step by step.
Scene in_own_motion(const Scene& scene);

/// The duration of a quasi-static case's damped motion in crossing times, during all of which its load grows.
/// It is slow enough for the body to stay near its equilibria, and for mean steps to be within 2 % of a
/// slower motion's.
inline constexpr double own_motion_crossings = 3.5;

/// The damping of this motion times the crossing time. Other programs are measured with the same value
/// (exchange/decks/problem.py).
inline constexpr double own_motion_damping = 2.0;

/// The number of states of a motion in which steps are timed, if they do not all cost the same.
inline constexpr std::size_t levels_on_the_way = 8;

/// A method's steps in a motion.
struct OwnMotion {
  std::optional<double> mean_step = {};  ///< s: simulated time over the number of steps; none: it fails
  std::string remark = {};  ///< why it fails, or which states need far shorter steps; mostly empty
  NodalField end = {};      ///< displacements (m) at its end, empty if it fails
  /// For an adaptive method, the levels of its elements in the middle of `levels_on_the_way` equal numbers of
  /// steps.
  std::vector<std::vector<double>> levels = {};
  double adaption = 0.0;  ///< s, time of the choice of levels, divided among the steps
};

/// Computes a scene's own motion with a method on one thread, in float, or in double for an adaptive method.
/// A motion that fails, or whose steps shrink until it would take a hundred times as many as with the
/// undeformed step, has no mean step, but a remark. A motion whose steps times elements would exceed the
/// limit is not followed, and has a remark only. Throws ComputationError if interrupted, InputError for a
/// method that takes no steps.
OwnMotion follow_own_motion(const Scene& scene, MethodChoice choice, const Proceed& proceed,
                            double most_element_steps = INFINITY);

}  // namespace sandglass
