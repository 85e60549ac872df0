#pragma once

#include <string>

#include "mesh/node_set.hpp"
#include "mesh/ties.hpp"

namespace sandglass {

/// The number of elements, boundary faces and edges of elements with all their nodes in a set.
struct SetShape {
  std::size_t elements = 0, faces = 0, edges = 0;
};
SetShape shape_of(const Mesh& mesh, const std::vector<Quadrilateral>& boundary,
                  const std::vector<int>& nodes);

/// Descriptions of nodes that seem to be one plane but are divided by the end of a rule's interval, for each
/// rule with such nodes: "sets.NAME selects ...". These are four or more nodes whose coordinates differ by
/// less than a fiftieth of the shortest edge, while all others are five times as far away.
std::vector<std::string> cut_planes(const Mesh& mesh, const std::vector<bool>& on_boundary,
                                    const std::vector<NodeSetRule>& rules);

/// Nodes of the boundary that lie at one place, within the rounding of the mesh, but are not joined.
struct Seam {
  std::size_t pairs = 0;
  int first = -1, second = -1;  ///< one pair of nodes
  double distance = 0.0;        ///< the largest, m
};
Seam seam_of(const Mesh& mesh, const Ties& ties, const std::vector<Quadrilateral>& boundary);

/// The fault and its remedy as text; empty without any pair.
std::string described(const Seam& seam, const Mesh& mesh);

}  // namespace sandglass
