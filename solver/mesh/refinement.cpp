#include "mesh/refinement.hpp"

#include <algorithm>
#include <map>
#include <unordered_set>

#include "mesh/hexahedron.hpp"
#include "mesh/node_elements.hpp"

namespace sandglass {

namespace {

/// The corners, in VTK order, that agree with a point of the 3 x 3 x 3 lattice of a split element (each
/// coordinate -1, 0 or 1) in every coordinate that is not zero.
std::vector<std::size_t> parents_of(const std::array<int, 3>& point) {
  std::vector<std::size_t> corners;
  for (int I = 0; I < corner_signs.rows; ++I) {
    bool agrees = true;
    for (int i = 0; i < 3; ++i) {
      const int x = point[at(i)];
      agrees = agrees && (x == 0 || x == static_cast<int>(corner_signs(I, i)));
    }
    if (agrees) corners.push_back(at(I));
  }
  return corners;
}

/// The same for all points of the lattice; the first coordinate varies fastest.
const std::vector<std::vector<std::size_t>>& lattice() {
  static const auto all = [] {
    std::vector<std::vector<std::size_t>> found;
    for (int k = 0; k < 27; ++k) found.push_back(parents_of({k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1}));
    return found;
  }();
  return all;
}

bool is_edge_or_face(const std::vector<std::size_t>& corners) {
  return corners.size() == 2 || corners.size() == 4;
}

EdgeOrFace sorted_corners(const Hexahedron& cell, const std::vector<std::size_t>& corners) {
  EdgeOrFace nodes{-1, -1, -1, -1};
  for (std::size_t i = 0; i < corners.size(); ++i) nodes[i] = cell[corners[i]];
  std::sort(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(corners.size()));
  return nodes;
}

}  // namespace

RefinedMesh::RefinedMesh(const Mesh& mesh)
    : mesh_(mesh), original_nodes_(mesh.points.size()), splits_(mesh.cells.size(), 0) {
  for (std::size_t e = 0; e < mesh.cells.size(); ++e) original_.push_back(static_cast<int>(e));
}

std::size_t RefinedMesh::Hash::operator()(const EdgeOrFace& corners) const {
  std::size_t hash = 0;
  for (const int n : corners) hash = 1'000'003 * hash + static_cast<std::size_t>(n);
  return hash;
}

/// A new node in the middle of some corners of an element.
int RefinedMesh::new_node(const Hexahedron& cell, const std::vector<std::size_t>& corners) {
  std::vector<int> parents;
  for (const std::size_t I : corners) parents.push_back(cell[I]);
  std::sort(parents.begin(), parents.end());
  mesh_.points.push_back(mean_at(parents, mesh_.points));
  parents_.push_back(std::move(parents));
  return static_cast<int>(mesh_.points.size()) - 1;
}

/// The node at a point of an element's lattice between some of its corners, created if necessary.
int RefinedMesh::node_at(const Hexahedron& cell, const std::vector<std::size_t>& corners) {
  if (corners.size() == 1) return cell[corners[0]];
  if (!is_edge_or_face(corners)) return new_node(cell, corners);
  const auto [entry, is_new] = middles_.try_emplace(sorted_corners(cell, corners), 0);
  if (is_new) entry->second = new_node(cell, corners);
  return entry->second;
}

/// Marks elements that share nodes with marked ones but have been split less often, until there are none.
void RefinedMesh::balance(std::vector<bool>& marked) const {
  const NodeElements elements(mesh_);
  std::vector<int> todo;
  for (std::size_t e = 0; e < marked.size(); ++e)
    if (marked[e]) todo.push_back(static_cast<int>(e));
  const auto visit = [&](int e, const std::vector<int>& with) {
    // elements that have all of these nodes
    for (const int other : elements.around(with[0])) {
      if (marked[at(other)] || splits_[at(other)] >= splits_[at(e)]) continue;
      const auto& cell = mesh_.cells[at(other)];
      const bool has_all = std::all_of(with.begin(), with.end(), [&](int n) {
        return std::find(cell.begin(), cell.end(), n) != cell.end();
      });
      if (!has_all) continue;
      marked[at(other)] = true;
      todo.push_back(other);
    }
  };
  while (!todo.empty()) {
    const int e = todo.back();
    todo.pop_back();
    for (const int n : mesh_.cells[at(e)]) {
      visit(e, {n});
      if (at(n) >= original_nodes_) visit(e, parents_[at(n) - original_nodes_]);
    }
  }
}

void RefinedMesh::split(std::vector<bool> marked) {
  balance(marked);
  const Mesh before = mesh_;
  CoarserMesh coarser{mesh_, to_free_nodes(ties_), {}, {}};
  const auto splits = splits_, original = original_;
  mesh_.cells.clear();
  splits_.clear();
  original_.clear();
  for (std::size_t e = 0; e < before.cells.size(); ++e) {
    const Hexahedron& cell = before.cells[e];
    if (!marked[e]) {
      mesh_.cells.push_back(cell);
      coarser.element_of.push_back(static_cast<int>(e));
      splits_.push_back(splits[e]);
      original_.push_back(original[e]);
      continue;
    }
    std::array<int, 27> nodes{};
    for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = node_at(cell, lattice()[k]);
    for (int child = 0; child < corner_signs.rows; ++child) {
      Hexahedron part;
      for (int I = 0; I < corner_signs.rows; ++I) {
        int k = 0;
        for (int i = 2; i >= 0; --i)
          k = 3 * k + 1 + static_cast<int>(corner_signs(I, i) + corner_signs(child, i)) / 2;
        part[at(I)] = nodes[at(k)];
      }
      mesh_.cells.push_back(part);
      coarser.element_of.push_back(static_cast<int>(e));
      splits_.push_back(splits[e] + 1);
      original_.push_back(original[e]);
    }
  }
  const auto known = static_cast<std::ptrdiff_t>(before.points.size() - original_nodes_);
  coarser.corners.assign(parents_.begin() + known, parents_.end());
  coarser_.push_back(std::move(coarser));
  ties_ = make_ties();
}

Ties RefinedMesh::make_ties() const {
  std::vector<bool> is_corner(mesh_.points.size(), false);  // of elements to split; most nodes are not
  for (const auto& [corners, middle] : middles_)
    for (const int n : corners)
      if (n >= 0) is_corner[at(n)] = true;
  std::map<int, Tie> tied;
  for (const auto& cell : mesh_.cells) {
    for (const auto& corners : lattice()) {
      if (!is_edge_or_face(corners) || !is_corner[at(cell[corners[0]])]) continue;
      const auto middle = middles_.find(sorted_corners(cell, corners));
      if (middle == middles_.end()) continue;
      Tie tie{middle->second, {}};
      for (const int n : parents_[at(tie.node) - original_nodes_])
        tie.mean_of.push_back({n, 1.0 / static_cast<double>(corners.size())});
      tied.emplace(tie.node, std::move(tie));
    }
  }
  Ties ties;
  for (auto& [node, tie] : tied) ties.push_back(std::move(tie));
  return ties;
}

std::vector<Quadrilateral> RefinedMesh::boundary() const {
  std::unordered_set<int> inside;  // nodes in the middle of faces that are split on one side
  for (const Tie& tie : ties_)
    if (tie.mean_of.size() == 4) inside.insert(tie.node);
  std::vector<Quadrilateral> faces;
  for (const auto& face : boundary_faces(mesh_.cells)) {
    EdgeOrFace corners = face;
    std::sort(corners.begin(), corners.end());
    const bool is_split = middles_.count(corners) > 0;
    const bool is_part = std::any_of(face.begin(), face.end(), [&](int n) { return inside.count(n) > 0; });
    if (!is_split && !is_part) faces.push_back(face);
  }
  return faces;
}

std::vector<int> RefinedMesh::nodes_of(const std::vector<int>& set) const {
  std::vector<bool> in(mesh_.points.size(), false);
  for (const int n : set) in[at(n)] = true;
  for (std::size_t k = 0; k < parents_.size(); ++k) {
    in[original_nodes_ + k] =
        std::all_of(parents_[k].begin(), parents_[k].end(), [&](int n) { return in[at(n)]; });
  }
  std::vector<int> nodes;
  for (std::size_t n = 0; n < in.size(); ++n)
    if (in[n]) nodes.push_back(static_cast<int>(n));
  return nodes;
}

std::vector<int> RefinedMesh::elements_of(const std::vector<int>& set) const {
  std::vector<int> elements;
  for (std::size_t e = 0; e < original_.size(); ++e)
    if (std::binary_search(set.begin(), set.end(), original_[e])) elements.push_back(static_cast<int>(e));
  return elements;
}

}  // namespace sandglass
