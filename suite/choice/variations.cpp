#include "choice/variations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "base/error.hpp"

namespace sandglass {

namespace {

constexpr std::array<std::array<std::size_t, 2>, 12> edges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

/// Calls visit(count) for every integer parameter of a generator; all are counts of elements.
template <class Generator, class Visit>
void for_each_count(Generator& generator, const Visit& visit) {
  const auto look = [&]<class Owner, class Value>(const Parameter<Owner, Value>& parameter) {
    if constexpr (std::is_same_v<Value, int>) {
      visit(generator.*parameter.member);
    } else if constexpr (std::is_same_v<Value, std::array<int, 3>>) {
      for (int& count : generator.*parameter.member) visit(count);
    }
  };
  std::apply([&](const auto&... parameter) { (look(parameter), ...); }, Generator::parameters());
}

/// The smallest count of elements.
template <class Generator>
int fewest_of(Generator generator) {
  int fewest = std::numeric_limits<int>::max();
  for_each_count(generator, [&](int count) { fewest = std::min(fewest, count); });
  return fewest;
}

/// The generator with other counts, at least 1: `change(count, smallest)` gives the new count.
template <class Change>
AnyGenerator with_counts(AnyGenerator generator, const Change& change) {
  std::visit(
      [&](auto& g) {
        const int fewest = fewest_of(g);
        for_each_count(g, [&](int& count) { count = std::max(1, change(count, fewest)); });
      },
      generator);
  return generator;
}

AnyGenerator with_share_of_elements(const AnyGenerator& generator, double share) {
  return with_counts(generator, [&](int count, int) { return static_cast<int>(std::lround(share * count)); });
}

}  // namespace

std::vector<ElementCount> element_counts(const AnyGenerator& generator) {
  std::vector<ElementCount> found;
  std::visit(
      [&]<class Generator>(const Generator& g) {
        const auto look = [&]<class Owner, class Value>(const Parameter<Owner, Value>& parameter) {
          if constexpr (std::is_same_v<Value, int>) {
            found.push_back({parameter.name, {g.*parameter.member}});
          } else if constexpr (std::is_same_v<Value, std::array<int, 3>>) {
            const auto& counts = g.*parameter.member;
            found.push_back({parameter.name, {counts.begin(), counts.end()}});
          }
        };
        std::apply([&](const auto&... parameter) { (look(parameter), ...); }, Generator::parameters());
      },
      generator);
  return found;
}

std::string counts_text(const AnyGenerator& generator) {
  std::string text;
  for (const auto& [parameter, counts] : element_counts(generator)) {
    text += fmt::format("{}{} = ", text.empty() ? "" : ", ", parameter);
    text += counts.size() == 1 ? fmt::to_string(counts[0]) : fmt::format("[{}]", fmt::join(counts, ", "));
  }
  return text;
}

std::vector<AnyGenerator> coarser_meshes(const AnyGenerator& generator) {
  std::vector<AnyGenerator> meshes{generator};
  const auto add = [&](const AnyGenerator& mesh) {
    const auto counts = element_counts(mesh);
    const auto same = [&](const AnyGenerator& other) { return element_counts(other) == counts; };
    if (std::none_of(meshes.begin(), meshes.end(), same)) meshes.push_back(mesh);
  };
  add(with_counts(generator, [](int count, int fewest) { return count == fewest ? count - 1 : count; }));
  for (const double share : {0.75, 0.5}) add(with_share_of_elements(generator, share));
  meshes.erase(meshes.begin());
  return meshes;
}

AnyGenerator with_elements_across(AnyGenerator generator, int elements) {
  return with_counts(generator, [&](int count, int fewest) {
    return static_cast<int>(std::lround(double(count) * elements / fewest));
  });
}

std::vector<int> zigzag(const Mesh& mesh) {
  std::vector<std::vector<std::size_t>> neighbours(mesh.points.size());
  for (const auto& cell : mesh.cells) {
    for (const auto& [a, b] : edges) {
      neighbours[static_cast<std::size_t>(cell[a])].push_back(static_cast<std::size_t>(cell[b]));
      neighbours[static_cast<std::size_t>(cell[b])].push_back(static_cast<std::size_t>(cell[a]));
    }
  }
  std::vector<int> signs(mesh.points.size(), 0);
  std::vector<std::size_t> reached;
  for (std::size_t start = 0; start < signs.size(); ++start) {
    if (signs[start] != 0) continue;
    signs[start] = 1;
    reached = {start};
    while (!reached.empty()) {
      const std::size_t node = reached.back();
      reached.pop_back();
      for (const std::size_t next : neighbours[node]) {
        if (signs[next] == signs[node]) {
          throw InputError("this mesh has no zigzag, because an odd number of its edges form a closed ring");
        }
        if (signs[next] != 0) continue;
        signs[next] = -signs[node];
        reached.push_back(next);
      }
    }
  }
  return signs;
}

}  // namespace sandglass
