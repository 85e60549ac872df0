#pragma once

#include "element/modes.hpp"

namespace sandglass {

/// What an element sees of its nodes, in modes. A Total Lagrangian element needs the displacements alone; who
/// needs more says so with `needs_increment` or `needs_coordinates`, and what nobody needs is not gathered.
template <class T>
struct ElementMotion {
  Modes<T> u;          ///< displacements, m
  Modes<T> increment;  ///< what the last step added to them, m
  Modes<T> X;          ///< reference coordinates, m
  T inverse_step;      ///< 1/s, of the time that the increment took; 0 where time plays no part
};

/// The history of an element that remembers nothing: its force follows from the displacements.
template <class T>
struct NoHistory {};

}  // namespace sandglass
