#include "comparison/published.hpp"

#include <algorithm>
#include <cmath>

#include "comparison/reference_file.hpp"
#include "math/spectral.hpp"
#include "mesh/vectors.hpp"

namespace sandglass {

namespace {

/// An extremum of a motion, s and m or rad.
struct Extremum {
  double time, value;
};

/// The extrema on the side to which a motion starts, from its values at equal time steps (s).
std::vector<Extremum> extrema(const std::vector<double>& motion, double step) {
  std::vector<Extremum> found;
  const double side = motion[1] < motion[0] ? -1.0 : 1.0;
  for (std::size_t k = 1; k + 1 < motion.size(); ++k) {
    const double before = side * (motion[k] - motion[k - 1]), after = side * (motion[k + 1] - motion[k]);
    if (before <= 0.0 || after > 0.0) continue;
    const double shift = 0.5 * (before + after) / (before - after);
    found.push_back(
        {step * (static_cast<double>(k) + shift), motion[k] + 0.25 * side * (before + after) * shift});
  }
  return found;
}

}  // namespace

std::optional<std::vector<double>> point_weights(const NodalField& points, const std::vector<int>& nodes,
                                                 const Vector& at_point) {
  const Vector middle = mean_at(nodes, points);
  const auto arm_of = [&](const Vector& X) {
    return Vector{X[0] - middle[0], X[1] - middle[1], X[2] - middle[2]};
  };
  Tensor<double> spread{};
  for (const int node : nodes) {
    const Vector r = arm_of(points[at(node)]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) spread(i, j) += r[at(i)] * r[at(j)];
  }
  const Tensor<double> axes = detail::diagonalize(spread);
  const double largest = std::max({spread(0, 0), spread(1, 1), spread(2, 2)});
  const Vector arm = arm_of(at_point);
  Vector slope{};  // the inverse of `spread` in its range, times the arm
  for (int a = 0; a < 3; ++a) {
    const Vector axis{axes(0, a), axes(1, a), axes(2, a)};
    const double along = dot(axis, arm);
    if (spread(a, a) > 1e-12 * largest) {
      for (std::size_t i = 0; i < 3; ++i) slope[i] += along / spread(a, a) * axis[i];
    } else if (std::abs(along) > 1e-6 * length(arm)) {
      return std::nullopt;
    }
  }
  std::vector<double> weights;
  for (const int node : nodes)
    weights.push_back(1.0 / static_cast<double>(nodes.size()) + dot(arm_of(points[at(node)]), slope));
  return weights;
}

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
  if (published.at) {
    const std::vector<double> weights = point_weights(scene.mesh.points, nodes, *published.at).value();
    double sum = 0.0;
    for (std::size_t n = 0; n < nodes.size(); ++n) sum += weights[n] * u[at(nodes[n])][axis];
    return sum;
  }
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

std::optional<double> computed_value(const Scene& scene, const Displacements& u,
                                     const PublishedValue& published) {
  if (published.of == Feature::end) return motion_of(scene, u.back(), published);
  std::vector<double> motion{0.0};
  for (const NodalField& frame : u) motion.push_back(motion_of(scene, frame, published));
  const auto found = extrema(motion, answer_times(scene.settings).front());
  const std::size_t needed = published.of == Feature::period ? 2 : 1;
  if (found.size() < needed) return std::nullopt;
  return needed == 2 ? found[1].time - found[0].time : found[0].value;
}

std::vector<PublishedResult> published_results(const Scene& scene, const std::vector<PublishedValue>& values,
                                               const std::optional<Displacements>& truth,
                                               const std::optional<Displacements>& golden) {
  std::vector<PublishedResult> results;
  for (const auto& published : values) {
    PublishedResult result{published, {}, {}, {}};
    if (!published.obstacles.empty()) {  // references are displacements
      results.push_back(std::move(result));
      continue;
    }
    if (truth) result.truth = computed_value(scene, *truth, published);
    if (golden) result.golden = computed_value(scene, *golden, published);
    results.push_back(std::move(result));
  }
  return results;
}

std::optional<double> force_of(const std::vector<ReactionsAt>& checks, const PublishedValue& published) {
  if (checks.empty()) return std::nullopt;
  const auto axis = static_cast<std::size_t>(published.component[0] - 'x');
  const auto force_at = [&](const ReactionsAt& check) {
    double sum = 0.0;
    for (const std::string& obstacle : published.obstacles) sum += check.reactions.at(obstacle)[axis];
    return sum;
  };
  const double start = checks.back().time - published.over;
  double impulse = 0.0, time = 0.0;
  for (std::size_t k = 1; k < checks.size(); ++k) {
    if (checks[k - 1].time < start) continue;
    impulse += (checks[k].time - checks[k - 1].time) * force_at(checks[k]);
    time += checks[k].time - checks[k - 1].time;
  }
  return time > 0.0 ? impulse / time : force_at(checks.back());
}

void fill_computed(const Scene& scene, const Displacements& u, const std::vector<ReactionsAt>& checks,
                   std::vector<PublishedResult>& results) {
  for (auto& [published, computed, truth, golden] : results) {
    computed =
        published.obstacles.empty() ? computed_value(scene, u, published) : force_of(checks, published);
  }
}

std::optional<double> largest_relative_error(const std::vector<PublishedResult>& results, bool measured,
                                             bool periods) {
  std::optional<double> largest;
  for (const auto& result : results) {
    const PublishedValue& value = result.published;
    if (value.scatter.has_value() != measured || (value.of == Feature::period) != periods) continue;
    if (const auto ratio = result.ratio()) largest = std::max(largest.value_or(0.0), std::abs(*ratio - 1.0));
  }
  return largest;
}

}  // namespace sandglass
