#pragma once

#include "mesh/ties.hpp"

namespace sandglass {

/// What holds a body, such as a constraint, a spring or a contact: the mean of the displacements of some
/// nodes is zero, or resisted, in a direction.
struct Hold {
  std::vector<Tie::Share> mean_of;  ///< the weights add up to one
  Vector direction;                 ///< of length one
};

/// The directions x, y and z.
inline constexpr std::array<Vector, 3> coordinate_axes{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

/// The small rigid motion u(X) = translation + rotation x (X - centre) / radius of a piece.
struct RigidMotion {
  Vector translation, rotation;
};

/// Elements that form a rigid body as long as they do not deform: those joined by faces, and what else is
/// joined to them by nodes or ties that are not all on a line.
struct RigidPiece {
  std::vector<int> elements;  ///< in ascending order
  Vector centre;              ///< of its bounding box, m
  double radius;              ///< half the diagonal of that, m
};

/// Pieces that are free to move without deforming, and hang together by edges, single nodes or ties.
struct LooseBody {
  std::vector<RigidPiece> pieces;
  std::vector<std::vector<RigidMotion>> motions;  ///< a basis of these motions; each has one for every piece
};

/// All rigid motions against which nothing holds a mesh: the null space of its stiffness in the undeformed
/// state. A motion counts as free where it moves all that is held by at most 1e-5 of what it moves the rest:
/// files round coordinates to 5e-6 of their size at worst, and no mesh has so many elements in a row that a
/// lever is as short as that. More than 100 pieces that hang together so, and are not held one by one, are
/// not examined.
std::vector<LooseBody> free_motions(const Mesh& mesh, const Ties& ties, const std::vector<Hold>& holds);

/// The displacement (m) at a point X (m) of a piece.
Vector displacement_of(const RigidMotion& motion, const RigidPiece& piece, const Vector& X);

}  // namespace sandglass
