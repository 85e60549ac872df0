#pragma once

#include <string_view>

/// What kinematics and hourglass controls state about themselves, each as `traits`. All have the same names
/// for it, and a misspelt one does not compile.
namespace sandglass {

/// Of kinematics. Those with several points also have `smallest_jacobian`.
struct KinematicsTraits {
  int points = 1;                    ///< integration points
  bool needs_increment = false;      ///< the force needs the displacements of the step
  bool needs_coordinates = false;    ///< the force needs the reference coordinates
  bool averages_over_nodes = false;  ///< the force needs the dilatation around each node
  bool averages_pressure = false;    ///< several points share a pressure
  bool small_strain = false;         ///< stresses follow from sym(H)
  std::string_view demand = {};      ///< the condition of `accepts` in words, for kinematics that have one
};

/// Of an hourglass control.
struct HourglassTraits {
  bool active = true;
  bool takes_kappa = false;          ///< a user may choose its strength
  bool damps_only = false;           ///< resists only velocities: dissipates, and gives no force at rest
  bool follows_deformation = false;  ///< the mean one; see following.hpp
  bool grows_with_deformation = false;
};

}  // namespace sandglass
