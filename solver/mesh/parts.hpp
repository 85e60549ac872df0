#pragma once

#include <vector>

#include "mesh/ties.hpp"

namespace sandglass {

/// The part of the body that each node belongs to, numbered from 0 in the order of the nodes: elements that
/// share a node or whose nodes are tied to each other are of one part. -1 for nodes of no element.
std::vector<int> parts_of_nodes(const Mesh& mesh, const Ties& ties);

/// How many parts there are.
int number_of_parts(const Mesh& mesh, const Ties& ties);

}  // namespace sandglass
