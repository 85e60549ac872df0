#include "comparison/published.hpp"

#include <algorithm>
#include <cmath>

namespace sandglass {

std::optional<double> PublishedResult::ratio() const {
  return computed ? std::optional(*computed / published.value) : std::nullopt;
}

std::optional<double> PublishedResult::ratio_to_truth() const {
  return computed && truth ? std::optional(*computed / *truth) : std::nullopt;
}

double motion_of(const Scene& scene, const NodalField& u, const PublishedValue& published) {
  const auto& nodes = scene.sets.at(published.set);
  const auto axis = static_cast<std::size_t>(published.component.back() - 'x');
  const auto mean = [&](const NodalField& field, std::size_t i) {
    double sum = 0.0;
    for (const int n : nodes) sum += field[static_cast<std::size_t>(n)][i];
    return sum / static_cast<double>(nodes.size());
  };
  if (published.component.size() == 1) return mean(u, axis);
  const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double middle_i = mean(scene.mesh.points, i), middle_j = mean(scene.mesh.points, j);
  double turned = 0.0, inertia = 0.0;
  for (const int node : nodes) {
    const auto n = static_cast<std::size_t>(node);
    const double r_i = scene.mesh.points[n][i] - middle_i, r_j = scene.mesh.points[n][j] - middle_j;
    turned += r_i * u[n][j] - r_j * u[n][i];
    inertia += r_i * r_i + r_j * r_j;
  }
  return turned / inertia;
}

std::vector<PublishedResult> published_results(const Scene& scene, const std::vector<PublishedValue>& values,
                                               const std::optional<NodalField>& truth) {
  std::vector<PublishedResult> results;
  for (const auto& published : values) {
    PublishedResult result{published, {}, {}};
    if (truth) result.truth = motion_of(scene, *truth, published);
    results.push_back(std::move(result));
  }
  return results;
}

void fill_computed(const Scene& scene, const NodalField& u, std::vector<PublishedResult>& results) {
  for (auto& result : results) result.computed = motion_of(scene, u, result.published);
}

std::optional<double> largest_relative_error(const std::vector<PublishedResult>& results) {
  std::optional<double> largest;
  for (const auto& result : results) {
    if (const auto ratio = result.ratio()) largest = std::max(largest.value_or(0.0), std::abs(*ratio - 1.0));
  }
  return largest;
}

}  // namespace sandglass
