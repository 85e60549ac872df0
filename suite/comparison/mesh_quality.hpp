#pragma once

#include "mesh/mesh.hpp"

namespace sandglass {

/// The smallest scaled Jacobian of a hexahedron's corners: det of the three unit edge vectors; 1 for a box.
double scaled_jacobian(const NodalVectors<double>& X);

/// The quality of the elements of a mesh: the distribution of their scaled Jacobians.
struct QualityTable {
  struct Element {
    std::size_t number;      ///< in the mesh, from 0
    double scaled_jacobian;  ///< of its worst corner
    Vector centre;           ///< mean of its nodes, m
  };
  double smallest = 1.0;
  double largest = 0.0;
  std::array<int, 11> counts{};  ///< of elements at or below zero, and in each tenth of (0, 1]
  std::vector<Element> worst;    ///< at most ten, the worst first
};

/// The quality of all elements of a mesh.
QualityTable quality_table(const Mesh& mesh);

}  // namespace sandglass
