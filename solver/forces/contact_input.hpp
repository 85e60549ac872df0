#pragma once

#include "forces/force_resolver.hpp"

/// What the tables [[obstacle]] and [[contact]] share when they are resolved.
namespace sandglass {

/// What the stiffness of a contact follows: the smallest Young's modulus and the shortest edge of the
/// elements with a face among some.
struct ContactScale {
  double modulus = INFINITY;  ///< Pa
  double edge = INFINITY;     ///< m

  ContactScale(const NodalField& points, std::span<const Hexahedron> cells,
               const std::vector<double>& young_moduli, const std::vector<Quadrilateral>& faces);

  /// The stiffness per area, Pa/m, of a penalty.
  double stiffness(double penalty) const { return penalty * modulus / edge; }

  /// Rounding of coordinates in files, m.
  double rounding() const { return 1e-6 * edge; }
};

/// How often faces whose normals point outwards enclose x (m): 1 inside of a body, 0 outside. The sum of the
/// solid angles of triangles over 4 pi (Van Oosterom and Strackee 1983).
double winding_number(const Vector& x, const std::vector<Quadrilateral>& faces, const NodalField& points);

/// A node of a surface that lies within a body with faces of the other surface, which may be its own; -1:
/// none. Nodes are taken just within their own elements, so that bodies may touch; also edges, deeper within.
int node_within_body(const ForceResolver& resolver, const std::vector<Quadrilateral>& surface,
                     const std::vector<Quadrilateral>& other);

/// Throws InputError unless a contact can be reported under a name (`label`) of its own.
void require_own_name(const ForceResolver& resolver, std::string_view table, const std::string& label);

/// Throws InputError: a contact (`label`) of a table cannot be, for a node; `what` follows its place.
[[noreturn]] void refuse_node(const ForceResolver& resolver, std::string_view table, const std::string& label,
                              int node, const std::string& what, const std::string& allowed);

/// The rule that the name of a contact breaks by itself, if any.
std::optional<BrokenRule> broken_rule_of_name(const std::string& label);

}  // namespace sandglass
