#pragma once

#include "element/modes.hpp"
#include "element/traits.hpp"

namespace sandglass {

/// The motion of an element's nodes, in modes. A Total Lagrangian element needs only the displacements;
/// kinematics that need more state `needs_increment`, `needs_coordinates` or `averages_over_nodes`, and only
/// what they need is gathered.
template <class T>
struct ElementMotion {
  Modes<T> u;                   ///< displacements, m
  Modes<T> increment;           ///< their change in the last step, m
  Modes<T> X;                   ///< reference coordinates, m
  T inverse_step;               ///< 1 / length of the last step, 1/s; 0 in quasi-static runs
  std::array<T, 8> dilatation;  ///< volume change over reference volume of all elements around each node
};

/// The contribution of an element that averages over nodes to each of its nodes in the first pass: a share of
/// its change of volume and of its reference volume, m^3.
template <class T>
struct NodalVolumes {
  std::array<T, 8> change;
  std::array<T, 8> reference;
};

/// The same of one face: a share for each of its nodes.
template <class T>
struct FaceVolumes {
  std::array<T, 4> change;
  std::array<T, 4> reference;

  friend FaceVolumes operator+(const FaceVolumes& a, const FaceVolumes& b) {
    FaceVolumes sum;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      sum.change[corner] = a.change[corner] + b.change[corner];
      sum.reference[corner] = a.reference[corner] + b.reference[corner];
    }
    return sum;
  }
};

template <class T>
FacePair<FaceVolumes<T>> on_faces(const NodalVolumes<T>& volumes) {
  FacePair<FaceVolumes<T>> pair;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    pair.lower.change[corner] = volumes.change[corner];
    pair.lower.reference[corner] = volumes.reference[corner];
    pair.upper.change[corner] = volumes.change[4 + corner];
    pair.upper.reference[corner] = volumes.reference[4 + corner];
  }
  return pair;
}

/// The history of an element without one: its force follows from the displacements.
template <class T>
struct NoHistory {};

}  // namespace sandglass
