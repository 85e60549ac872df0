#include "assembly/strips.hpp"

#include <algorithm>
#include <optional>
#include <ranges>

namespace sandglass {

namespace {

/// The lower and the upper face of an element across each parent axis, as local nodes; every pair is the
/// element in VTK order, rotated.
using LocalFaces = std::array<std::array<std::size_t, 4>, 2>;
constexpr std::array<LocalFaces, 3> faces_across{
    {{{{0, 1, 2, 3}, {4, 5, 6, 7}}}, {{{0, 3, 7, 4}, {1, 2, 6, 5}}}, {{{0, 4, 5, 1}, {3, 7, 6, 2}}}}};

/// The node at the other end of the edge that leaves `face` at its given corner.
int opposite_node(const Hexahedron& cell, const Quadrilateral& face, std::size_t corner) {
  const auto local = [&](int node) {
    return static_cast<std::size_t>(std::ranges::find(cell, node) - cell.begin());
  };
  const std::size_t from = local(face[corner]);
  const auto on_face = [&](int node) { return std::ranges::find(face, node) != face.end(); };
  for (const auto& across : faces_across) {
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t a = across[0][k], b = across[1][k];
      if (a == from && !on_face(cell[b])) return cell[b];
      if (b == from && !on_face(cell[a])) return cell[a];
    }
  }
  return -1;  // not reached: a corner of a face has one edge that leaves it
}

class StripCutter {
 public:
  StripCutter(const Mesh& mesh, const NodeElements& neighbours, std::span<const int> elements)
      : mesh_(mesh), neighbours_(neighbours), open_(mesh.cells.size(), false) {
    for (const int e : elements) open_[at(e)] = true;
  }

  bool open(int element) const { return open_[at(element)]; }

  /// The longest strip through an open element; closes its elements.
  Strip take(int element) {
    Strip longest;
    for (const auto& across : faces_across) {
      Strip strip = through(element, across);
      if (strip.length() > longest.length()) longest = std::move(strip);
    }
    for (const int e : longest.elements) open_[at(e)] = false;
    return longest;
  }

 private:
  Strip through(int element, const LocalFaces& across) {
    const Hexahedron& cell = mesh_.cells[at(element)];
    std::array<Quadrilateral, 2> ends{};
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t k = 0; k < 4; ++k) ends[side][k] = cell[across[side][k]];
    }
    Strip strip{{ends[0], ends[1]}, {element}};
    open_[at(element)] = false;  // a strip may be a ring
    extend(strip);
    std::ranges::reverse(strip.faces);
    std::ranges::reverse(strip.elements);
    extend(strip);
    std::ranges::reverse(strip.faces);
    std::ranges::reverse(strip.elements);
    for (const int e : strip.elements) open_[at(e)] = true;
    return strip;
  }

  /// Goes on beyond the last face while there is an open element.
  void extend(Strip& strip) {
    while (const auto next = beyond(strip.faces.back())) {
      const Quadrilateral last = strip.faces.back();
      Quadrilateral face{};
      for (std::size_t k = 0; k < 4; ++k) face[k] = opposite_node(mesh_.cells[at(*next)], last, k);
      strip.faces.push_back(face);
      strip.elements.push_back(*next);
      open_[at(*next)] = false;
    }
  }

  std::optional<int> beyond(const Quadrilateral& face) const {
    for (const int e : neighbours_.around(face[0])) {
      if (!open_[at(e)]) continue;
      const Hexahedron& cell = mesh_.cells[at(e)];
      const auto has = [&](int node) { return std::ranges::find(cell, node) != cell.end(); };
      if (has(face[1]) && has(face[2]) && has(face[3])) return e;
    }
    return std::nullopt;
  }

  const Mesh& mesh_;
  const NodeElements& neighbours_;
  std::vector<bool> open_;
};

}  // namespace

Hexahedron cell_between(const Quadrilateral& lower, const Quadrilateral& upper) {
  return {lower[0], lower[1], lower[2], lower[3], upper[0], upper[1], upper[2], upper[3]};
}

std::vector<Strip> cut_into_strips(const Mesh& mesh, const NodeElements& neighbours,
                                   std::span<const int> elements) {
  StripCutter cutter(mesh, neighbours, elements);
  std::vector<Strip> strips;
  for (const int e : elements) {
    if (cutter.open(e)) strips.push_back(cutter.take(e));
  }
  return strips;
}

}  // namespace sandglass
