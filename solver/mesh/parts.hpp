#pragma once

#include <vector>

#include "mesh/ties.hpp"

namespace sandglass {

/// The part of the body to which each node belongs, numbered from 0 in the order of the nodes: elements that
/// share a node or have nodes tied to each other form one part. -1 for nodes without elements.
std::vector<int> parts_of_nodes(const Mesh& mesh, const Ties& ties);

/// The number of parts.
int number_of_parts(const Mesh& mesh, const Ties& ties);

}  // namespace sandglass
