#pragma once

#include <unordered_map>

#include "mesh/ties.hpp"

namespace sandglass {

/// The mesh before elements were split, and its relation to the finer mesh, whose first nodes are its nodes.
struct CoarserMesh {
  Mesh mesh;
  Ties ties;                    ///< to nodes that are not tied
  std::vector<int> element_of;  ///< the element of this mesh to which each element of the finer mesh belongs
  std::vector<std::vector<int>> corners;  ///< of each new node: the nodes whose mean it is
};

/// The corners of an edge, two and then -1, or of a face, in ascending order.
using EdgeOrFace = std::array<int, 4>;

/// A mesh in which some elements are split in eight, repeatedly. Nodes of small elements in the middle of an
/// edge or a face of a large one are tied to its corners. Elements that share a node differ by at most one
/// split; parts keep the trilinear shape of the original element.
class RefinedMesh {
 public:
  /// Starts without splits.
  explicit RefinedMesh(const Mesh& mesh);

  /// Splits the marked elements of the current mesh, and others as the rule above requires.
  void split(std::vector<bool> marked);

  const Mesh& mesh() const { return mesh_; }

  /// The ties of nodes in the middle of edges and faces that are not split on all sides, to their corners.
  const Ties& ties() const { return ties_; }

  /// The faces on the boundary of the body.
  std::vector<Quadrilateral> boundary() const;

  /// The meshes before each splitting, the last one first.
  std::vector<CoarserMesh> coarser() const { return {coarser_.rbegin(), coarser_.rend()}; }

  /// For each element, the number of splits and the original element.
  const std::vector<int>& splits() const { return splits_; }
  const std::vector<int>& original() const { return original_; }

  /// The members of a node set of the original mesh, and the new nodes on edges and faces and in elements
  /// whose corners are all members.
  std::vector<int> nodes_of(const std::vector<int>& set) const;

  /// The parts of the elements in a set of the original mesh.
  std::vector<int> elements_of(const std::vector<int>& set) const;

 private:
  struct Hash {
    std::size_t operator()(const EdgeOrFace& corners) const;
  };

  int new_node(const Hexahedron& cell, const std::vector<std::size_t>& corners);
  int node_at(const Hexahedron& cell, const std::vector<std::size_t>& corners);
  Ties make_ties() const;
  void balance(std::vector<bool>& marked) const;

  Mesh mesh_;
  std::size_t original_nodes_;
  std::vector<int> splits_, original_;
  std::vector<CoarserMesh> coarser_;
  Ties ties_;
  std::unordered_map<EdgeOrFace, int, Hash> middles_;  // of edges and faces
  std::vector<std::vector<int>> parents_;              // of each new node
};

}  // namespace sandglass
