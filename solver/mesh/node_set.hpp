#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace sandglass {

/// A closed interval of a coordinate, m; either end may be infinite.
struct Interval {
  double low;
  double high;
};

/// The inside of an infinite elliptic cylinder along a coordinate axis.
struct CylinderRegion {
  int axis = 2;                       ///< 0, 1, 2 for x, y, z
  std::array<double, 2> center{};     ///< the two other coordinates in the order of the axes, m
  std::array<double, 2> semi_axes{};  ///< m
};

/// The inside of an ellipsoid.
struct EllipsoidRegion {
  Vector center{};     ///< m
  Vector semi_axes{};  ///< m
};

/// A geometric rule that selects nodes; all its conditions must hold. Conditions are closed, with the
/// tolerance `rounding_of` the mesh, so that nodes meant to lie on a plane are found.
struct NodeSetRule {
  std::string name;
  bool surface = false;  ///< only nodes on the boundary
  std::array<std::optional<Interval>, 3> within;
  std::optional<CylinderRegion> cylinder;
  std::optional<EllipsoidRegion> ellipsoid = {};
};

/// The largest rounding (m) of a mesh's coordinates: files round them to six digits at worst, by 5e-6 of the
/// largest coordinate. At most a thousandth of the shortest edge, so that no two planes of nodes merge, and
/// at least 1e-9 of the diagonal, for roundoff in generators.
double rounding_of(const Mesh& mesh);

/// The nodes that a rule selects, sorted; the caller decides whether the result may be empty.
std::vector<int> select_nodes(const Mesh& mesh, const std::vector<bool>& on_boundary,
                              const NodeSetRule& rule);

/// For a rule that selects no node: the nearest node, its position, and the distance (m), as text.
std::string nearest_miss(const Mesh& mesh, const std::vector<bool>& on_boundary, const NodeSetRule& rule);

/// The elements whose centres, the means of their nodes, satisfy the conditions of a rule on positions;
/// sorted.
std::vector<int> select_elements(const Mesh& mesh, const NodeSetRule& rule);

/// The nodes, or elements, of a set that `key` of a case file names. Throws InputError that names the file
/// and the key if there is no such set, or if it is empty.
const std::vector<int>& named_node_set(const NodeSets& sets, const std::string& file, const std::string& key,
                                       const std::string& name);
const std::vector<int>& named_element_set(const ElementSets& sets, const std::string& file,
                                          const std::string& key, const std::string& name);

}  // namespace sandglass
