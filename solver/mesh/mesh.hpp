#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "mesh/hexahedron.hpp"

namespace sandglass {

/// A point, displacement, velocity or force in space.
using Vector = std::array<double, 3>;

/// One vector per node.
using NodalField = std::vector<Vector>;

/// The number of a node, an element or a component as an index.
constexpr std::size_t at(int n) {
  return static_cast<std::size_t>(n);
}

/// |v|.
inline double length(const Vector& v) {
  return std::hypot(v[0], v[1], v[2]);
}

/// |a - b|.
inline double distance(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Nodes and hexahedra, in the numbering that every file and table uses.
struct Mesh {
  NodalField points;  ///< m
  std::vector<Hexahedron> cells;
};

/// Named sets of nodes, each sorted.
using NodeSets = std::map<std::string, std::vector<int>>;

/// Named sets of elements, each sorted.
using ElementSets = std::map<std::string, std::vector<int>>;

/// The names of sets, in order.
template <class Set>
std::vector<std::string> names_in(const std::map<std::string, Set>& sets) {
  std::vector<std::string> names;
  for (const auto& [name, members] : sets) names.push_back(name);
  return names;
}

/// The rows of a nodal field at the nodes of one element.
inline NodalVectors<double> gather(const NodalField& field, const Hexahedron& cell) {
  NodalVectors<double> rows;
  for (int I = 0; I < rows.rows; ++I) {
    const Vector& row = field[at(cell[at(I)])];
    for (int i = 0; i < 3; ++i) rows(I, i) = row[at(i)];
  }
  return rows;
}

/// Adds numbers of rows, one row for each node of an element, to a nodal field.
template <class T, class Number = std::identity>
void scatter_add(const NodalVectors<T>& rows, const Hexahedron& cell, NodalField& field,
                 const Number& number = {}) {
  for (int I = 0; I < rows.rows; ++I) {
    Vector& row = field[at(cell[at(I)])];
    for (int i = 0; i < 3; ++i) row[at(i)] += number(rows(I, i));
  }
}

/// The vectors of a nodal field at some nodes.
template <class Nodes>
NodalField values_at(const Nodes& nodes, const NodalField& field) {
  NodalField values;
  values.reserve(nodes.size());
  for (const int node : nodes) values.push_back(field[at(node)]);
  return values;
}

/// The mean of a nodal field at some nodes; of the points at an element's nodes it is the element's centre.
template <class Nodes>
Vector mean_at(const Nodes& nodes, const NodalField& field) {
  Vector mean{};
  for (const int node : nodes) {
    for (std::size_t i = 0; i < 3; ++i) mean[i] += field[at(node)][i] / static_cast<double>(nodes.size());
  }
  return mean;
}

/// The largest distance between the vectors of two nodal fields; NaN if one of them contains NaN.
double largest_distance(const NodalField& a, const NodalField& b);

/// The faces that belong to one hexahedron only, in the order of the cells.
std::vector<Quadrilateral> boundary_faces(std::span<const Hexahedron> cells);

/// Whether each of a number of nodes belongs to one of some faces.
std::vector<bool> nodes_of(const std::vector<Quadrilateral>& faces, std::size_t nodes);

/// Whether each node lies on the boundary.
std::vector<bool> boundary_nodes(const Mesh& mesh);

/// The corners of the smallest box around the points; {low, high}, m.
std::array<Vector, 2> bounding_box(const NodalField& points);

/// Length of the diagonal of the bounding box, m: the mesh's own unit for tolerances.
double diagonal(const NodalField& points);

}  // namespace sandglass
