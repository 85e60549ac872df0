#include "forces/force_resolver.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "mesh/node_set.hpp"

namespace sandglass {

const std::vector<int>& ForceResolver::nodes(std::string_view table, const std::string& set,
                                             std::string_view key) const {
  return named_node_set(sets, file, fmt::format("{}.{}", table, key), set);
}

std::vector<Quadrilateral> ForceResolver::faces(std::string_view table, const std::string& set,
                                                std::string_view key) const {
  const std::vector<int>& all = nodes(table, set, key);
  auto within = faces_within(boundary, all);
  if (within.empty()) {
    throw InputError(fmt::format(
        "{}: {}.{} = '{}' has no boundary face among its {} nodes; [[{}]] acts on faces of the boundary "
        "whose four nodes all lie in its set",
        file, table, key, set, all.size(), table));
  }
  return within;
}

std::size_t ForceResolver::number_of(const LoadCurve& curve) {
  const auto known = std::find(curves.begin(), curves.end(), curve);
  const auto number = static_cast<std::size_t>(known - curves.begin());
  if (known == curves.end()) curves.push_back(curve);
  return number;
}

std::size_t ForceResolver::add_moves() {
  curves.insert(curves.end(), 3, LoadCurve{.share = 0.0});
  return curves.size() - 3;
}

void ForceResolver::add_dead(std::size_t curve, int node, const Vector& force, double factor) {
  Vector& sum = dead[{curve, node}];
  for (std::size_t i = 0; i < 3; ++i) sum[i] += factor * force[i];
}

BodyForces ForceResolver::all() const {
  BodyForces sorted;
  std::vector<NodalLoad> loads;
  for (const auto& [key, force] : dead) loads.push_back({key.second, force, key.first});
  if (!loads.empty())
    sorted.push_back(std::make_shared<DeadLoads>(std::move(loads), sizes_of_dead, slopes_of_dead));
  sorted.insert(sorted.end(), forces.begin(), forces.end());
  return sorted;
}

}  // namespace sandglass
