#pragma once

#include <optional>
#include <string>

#include "comparison/accuracy.hpp"
#include "problem/make_scene.hpp"

namespace sandglass {

/// One run of the stability lab: a case and a method, and what the axes of a map did to them.
struct Trial {
  Case description;
  MethodChoice choice;
  double load = 1.0;                 ///< times that of the case
  double aspect = 1.0;               ///< z of mesh and imposed motions times this
  double skew = 0.0;                 ///< and x plus this times z
  std::optional<double> step = {};   ///< dynamic: stable steps per step; none: static
  std::optional<double> noise = {};  ///< dynamic, without load, from a zigzag of velocities of this many
                                     ///< times the speed of shear waves

  bool is_dynamic() const { return step || noise; }
};

/// The scene of a trial. Sets are chosen on the mesh before it is stretched and skewed, and what is imposed
/// is stretched and skewed with it, so that displacement gradients stay. A dynamic trial takes the time that
/// a shear wave needs to cross the body: four times that under a load that grows for half of it, with
/// damping; ten times that, undamped, with noise. Throws InputError for a mesh that has no zigzag.
Scene scene_of(const Trial& trial);

/// The length that errors of a trial are fractions of (m): the largest imposed displacement, or the golden's
/// own; with noise what its velocity goes when nothing holds it.
double unit_of(const Trial& trial, const Scene& scene, const Displacements& golden);

/// Error up to which a trial is good, where `limit` is that of the case at rest: with noise a tenth of the
/// free way, for swinging is no error.
double limit_of(const Trial& trial, double limit);

/// The trial that a trial is measured by: the golden's own element, in double precision, at half the stable
/// step.
Trial golden_of(Trial trial);

/// The trial itself at half the stable step, where no explicit method should be unstable.
Trial careful(Trial trial);

/// A text that two trials share only when their answers are the same.
std::string key_of(const Trial& trial);

}  // namespace sandglass
