#include "mesh/hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <cmath>
#include <cstdint>

namespace sandglass {

namespace {

std::string digits(XXH64_hash_t hash) {
  return fmt::format("{:016x}", hash);
}

}  // namespace

std::string hash_of(std::string_view text) {
  return digits(XXH3_64bits(text.data(), text.size()));
}

std::string mesh_hash(const Mesh& mesh, const NodeSets& sets,
                      std::span<const std::uint16_t> material_of_element) {
  // The offset keeps lattice points, which are often multiples of the unit or of its half, away from the
  // limits of rounding.
  const double unit = 1e-7 * diagonal(mesh.points);
  constexpr double offset = 0.318;
  std::vector<std::int64_t> words{static_cast<std::int64_t>(mesh.points.size()),
                                  static_cast<std::int64_t>(mesh.cells.size())};
  for (const auto& point : mesh.points) {
    for (const double x : point) words.push_back(static_cast<std::int64_t>(std::floor(x / unit + offset)));
  }
  for (const auto& cell : mesh.cells) words.insert(words.end(), cell.begin(), cell.end());
  for (const auto& [name, nodes] : sets) {
    for (const char c : name) words.push_back(c);
    words.insert(words.end(), nodes.begin(), nodes.end());
  }
  words.insert(words.end(), material_of_element.begin(), material_of_element.end());
  return digits(XXH3_64bits(words.data(), words.size() * sizeof(std::int64_t)));
}

}  // namespace sandglass
