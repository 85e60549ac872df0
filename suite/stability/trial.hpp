#pragma once

#include <optional>
#include <string>

#include "comparison/accuracy.hpp"
#include "problem/make_scene.hpp"

namespace sandglass {

/// One run of a failure map: a case and a method, modified by the axes of the map.
struct Trial {
  Case description;
  MethodChoice choice;
  double load = 1.0;                 ///< factor of the case's loads
  double aspect = 1.0;               ///< factor of z of mesh and imposed motions
  double skew = 0.0;                 ///< this times z is added to x
  std::optional<double> step = {};   ///< dynamic: stable steps per step; none: static
  std::optional<double> noise = {};  ///< dynamic, without load: initial zigzag of velocities, over the speed
                                     ///< of shear waves

  bool is_dynamic() const { return step || noise; }
};

/// The scene of a trial. Sets are chosen on the mesh before it is stretched and skewed. Imposed displacements
/// are stretched and skewed with it, so displacement gradients do not change. The unit of time of a dynamic
/// trial is the time in which a shear wave crosses the body: with a load it lasts four of them, damped, and
/// the load grows during the first half; with noise it lasts ten, undamped. Throws InputError for a mesh
/// without a zigzag.
Scene scene_of(const Trial& trial);

/// The unit (m) of errors of a trial: the largest imposed displacement, or the golden's largest; with noise
/// the distance that a free node would move.
double unit_of(const Trial& trial, const Scene& scene, const Displacements& golden);

/// The largest error of a good trial, where `limit` is the case's static limit: with noise a tenth of the
/// free path, because vibration is no error.
double limit_of(const Trial& trial, double limit);

/// The reference of a trial: the golden's element, in double precision, at half the stable step.
Trial golden_of(Trial trial);

/// The same trial at half the stable step, at which no explicit method should be unstable.
Trial careful(Trial trial);

/// A text that two trials share only if their answers are the same.
std::string key_of(const Trial& trial);

}  // namespace sandglass
