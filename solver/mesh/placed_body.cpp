#include "mesh/placed_body.hpp"

#include <numbers>
#include <numeric>

#include "mesh/vectors.hpp"

namespace sandglass {

namespace {

/// x turned about the origin by Rodrigues' formula.
Vector turned(const Vector& x, const Vector& turn) {
  const double degrees = length(turn);
  if (degrees == 0.0) return x;
  const double angle = degrees / 180.0 * std::numbers::pi, c = std::cos(angle);
  const Vector axis = sum({}, 1.0 / degrees, turn);
  return sum(sum(sum({}, c, x), std::sin(angle), cross(axis, x)), (1.0 - c) * dot(axis, x), axis);
}

/// The numbers from `first` to below `end`.
std::vector<int> numbers(std::size_t first, std::size_t end) {
  std::vector<int> all(end - first);
  std::iota(all.begin(), all.end(), static_cast<int>(first));
  return all;
}

}  // namespace

std::optional<BrokenRule> PlacedBody::broken_rule() const {
  if (!label.empty() && label.find('/') == std::string::npos) return std::nullopt;
  return BrokenRule{"name", fmt::format("= '{}' must be a word without '/'", label)};
}

MeshWithSets build(const std::vector<PlacedBody>& bodies) {
  MeshWithSets all;
  auto& [points, cells] = all.mesh;
  for (const PlacedBody& body : bodies) {
    const std::size_t first_node = points.size(), first_cell = cells.size();
    const Mesh mesh = std::visit([](const auto& generator) { return generator.build(); }, body.generator);
    for (const Vector& X : mesh.points) points.push_back(sum(turned(X, body.turn), 1.0, body.offset));
    for (Hexahedron cell : mesh.cells) {
      for (int& node : cell) node += static_cast<int>(first_node);
      cells.push_back(cell);
    }
    all.sets[body.label] = numbers(first_node, points.size());
    all.element_sets[body.label] = numbers(first_cell, cells.size());
  }
  return all;
}

}  // namespace sandglass
