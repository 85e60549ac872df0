#pragma once

#include "element/modes.hpp"

namespace sandglass {

/// What an element sees of its nodes, in modes. A Total Lagrangian element needs the displacements alone; who
/// needs more says so with `needs_increment`, `needs_coordinates` or `averages_over_nodes`, and what nobody
/// needs is not gathered.
template <class T>
struct ElementMotion {
  Modes<T> u;                   ///< displacements, m
  Modes<T> increment;           ///< what the last step added to them, m
  Modes<T> X;                   ///< reference coordinates, m
  T inverse_step;               ///< 1/s, of the time that the increment took; 0 where time plays no part
  std::array<T, 8> dilatation;  ///< volume change over volume around each node, of all elements there
};

/// What an element that averages over nodes adds to each of its own before any force is known: a share of its
/// change of volume, and of its volume at rest, m^3.
template <class T>
struct NodalVolumes {
  std::array<T, 8> change;
  std::array<T, 8> reference;
};

/// The history of an element that remembers nothing: its force follows from the displacements.
template <class T>
struct NoHistory {};

}  // namespace sandglass
