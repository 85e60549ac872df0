#include "sandglass/mesh_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandglass {

MeshWithSets checked(MeshArrays arrays) {
  std::vector<bool> met(arrays.points.size(), false);
  const auto meet = [&](const std::string& name, int node) {
    if (node < 0 || static_cast<std::size_t>(node) >= met.size()) {
      throw InputError(fmt::format("mesh: {} names node {}; it must be in [0, {})", name, node, met.size()));
    }
    met[static_cast<std::size_t>(node)] = true;
  };
  for (auto& [name, nodes] : arrays.sets) {
    for (const int node : nodes) meet(fmt::format("set '{}'", name), node);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  std::fill(met.begin(), met.end(), false);
  for (std::size_t n = 0; n < arrays.points.size(); ++n) {
    for (const double x : arrays.points[n]) {
      if (!std::isfinite(x)) throw InputError(fmt::format("mesh: node {} is at {}; it must be finite", n, x));
    }
  }
  for (std::size_t e = 0; e < arrays.cells.size(); ++e) {
    for (const int node : arrays.cells[e]) meet(fmt::format("cell {}", e), node);
  }
  const auto alone = std::find(met.begin(), met.end(), false);
  if (met.empty() || alone != met.end()) {
    throw InputError(fmt::format("mesh: node {} of {} belongs to no cell; each must, and there must be some",
                                 std::distance(met.begin(), alone), met.size()));
  }
  return {{std::move(arrays.points), std::move(arrays.cells)}, std::move(arrays.sets)};
}

}  // namespace sandglass
