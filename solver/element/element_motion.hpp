#pragma once

#include "element/modes.hpp"
#include "element/traits.hpp"

namespace sandglass {

/// The motion of an element's nodes, in modes. A Total Lagrangian element needs only the displacements;
/// kinematics that need more state `needs_increment`, `needs_coordinates` or `averages_over_nodes`, and only
/// what they need is gathered.
template <class T>
struct ElementMotion {
  Modes<T> u;          ///< displacements, m
  Modes<T> increment;  ///< their change in the last step, m
  Modes<T> X;          ///< reference coordinates, m
  T inverse_step;      ///< 1 / length of the last step, 1/s; 0 in quasi-static runs
  std::array<T, 8>
      dilatation;  ///< volume change over reference volume around each node, of all elements there
};

/// What an element that averages over nodes contributes to each of its nodes in the first pass: a share of
/// its change of volume, and of its reference volume, m^3.
template <class T>
struct NodalVolumes {
  std::array<T, 8> change;
  std::array<T, 8> reference;
};

/// The history of an element without one: its force follows from the displacements.
template <class T>
struct NoHistory {};

}  // namespace sandglass
