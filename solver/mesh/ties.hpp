#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sandglass {

/// A node that moves as the weighted mean of others. The weights are positive, constant, and add up to one,
/// so the node follows every rigid motion, and a tied mesh has no higher frequencies than its elements.
struct Tie {
  struct Share {
    int node;
    double weight;
  };
  int node;
  std::vector<Share> mean_of;
};

/// Ties of different nodes, sorted by node.
using Ties = std::vector<Tie>;

/// The tie of a node; null if there is none.
const Tie* tie_of(const Ties& ties, int node);

/// Whether a node is tied.
bool is_tied(const Ties& ties, int node);

/// The same ties, each to nodes that are not tied themselves. Throws InputError for a cycle of ties.
Ties to_free_nodes(const Ties& ties);

/// Nodal values, such as masses, after tied nodes have passed theirs, by weight, to the nodes that they
/// follow; zero at tied nodes. `ties` are to free nodes.
std::vector<double> handed_on(const Ties& ties, std::vector<double> nodal);

/// Sets the tied nodes of a nodal field to the means that they follow. `ties` are to free nodes.
void follow(const Ties& ties, NodalField& field);

}  // namespace sandglass
