#pragma once

#include <unordered_map>

#include "mesh/ties.hpp"

namespace sandglass {

/// The mesh before elements were split, and how the mesh after that came from it. Its nodes are the first
/// ones of that.
struct CoarserMesh {
  Mesh mesh;
  Ties ties;                    ///< to nodes that are not tied
  std::vector<int> element_of;  ///< which element of this mesh each one of the finer mesh is a part of
  std::vector<std::vector<int>> corners;  ///< of the new nodes: the nodes whose mean they are
};

/// The corners of an edge, two and then -1, or of a face, in ascending order.
using EdgeOrFace = std::array<int, 4>;

/// A mesh whose elements are split in eight, some of them, of those some again, and so on. Nodes of small
/// elements in the middle of an edge or a face of a large one are tied to its corners. Elements that share a
/// node differ by at most one split; elements keep to the trilinear shapes of those they are made of.
class RefinedMesh {
 public:
  /// Nothing is split yet.
  explicit RefinedMesh(const Mesh& mesh);

  /// Splits the marked elements of the present mesh, and others as the rule above demands.
  void split(std::vector<bool> marked);

  const Mesh& mesh() const { return mesh_; }

  /// Of the nodes in the middle of edges and faces that are not split on all sides, to their corners.
  const Ties& ties() const { return ties_; }

  /// The faces on the boundary of the body.
  std::vector<Quadrilateral> boundary() const;

  /// The meshes before each time that elements were split, the last first.
  std::vector<CoarserMesh> coarser() const { return {coarser_.rbegin(), coarser_.rend()}; }

  /// How often the original element was split that each element is a part of, and which it is.
  const std::vector<int>& splits() const { return splits_; }
  const std::vector<int>& original() const { return original_; }

  /// The members of a set of nodes of the original mesh, and the new nodes on edges and faces and in elements
  /// whose corners are all in it.
  std::vector<int> nodes_of(const std::vector<int>& set) const;

  /// The elements that are parts of those in a set of the original mesh.
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
