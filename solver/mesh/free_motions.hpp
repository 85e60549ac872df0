#pragma once

#include "mesh/ties.hpp"

namespace sandglass {

/// A constraint, spring or contact that holds a body: the mean displacement of some nodes in a direction is
/// zero or resisted.
struct Hold {
  std::vector<Tie::Share> mean_of;  ///< with weights that add up to one
  Vector direction;                 ///< of length one
};

/// The directions x, y and z.
inline constexpr std::array<Vector, 3> coordinate_axes{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

/// The small rigid motion u(X) = translation + rotation x (X - centre) / radius of a piece.
struct RigidMotion {
  Vector translation, rotation;
};

/// Elements that only move together if they do not deform: joined by faces, or by nodes or ties that are not
/// all on a line.
struct RigidPiece {
  std::vector<int> elements;  ///< in ascending order
  Vector centre;              ///< of its bounding box, m
  double radius;              ///< half the diagonal of that, m
};

/// Pieces that are free to move without deforming, connected by edges, single nodes or ties.
struct LooseBody {
  std::vector<RigidPiece> pieces;
  std::vector<std::vector<RigidMotion>> motions;  ///< a basis of these motions; each has one for every piece
};

/// All rigid motions that nothing prevents: the null space of the stiffness of a mesh in the undeformed
/// state. A motion counts as free if it moves all holds by at most 1e-5 of its displacement elsewhere: files
/// round coordinates to at worst 5e-6 of their size, and no mesh has so many elements in a row that a lever
/// is that short. Groups of more than 100 pieces that are connected in this way and not held one by one are
/// not examined.
std::vector<LooseBody> free_motions(const Mesh& mesh, const Ties& ties, const std::vector<Hold>& holds);

/// The displacement (m) at a point X (m) of a piece.
Vector displacement_of(const RigidMotion& motion, const RigidPiece& piece, const Vector& X);

}  // namespace sandglass
