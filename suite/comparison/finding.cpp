#include "comparison/finding.hpp"

#include <algorithm>
#include <cmath>

#include "assembly/method_entry.hpp"
#include "comparison/accuracy.hpp"
#include "comparison/comparison.hpp"
#include "mesh/hexahedron.hpp"

namespace sandglass {

namespace {

NodalField difference(const NodalField& a, const NodalField& b) {
  NodalField d(a.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    for (std::size_t i = 0; i < 3; ++i) d[n][i] = a[n][i] - b[n][i];
  }
  return d;
}

double ratio(double a, double b) {
  return b > 0.0 ? a / b : 0.0;
}

}  // namespace

std::string_view name_of(Finding finding) {
  switch (finding) {
    case Finding::good:
      return "good";
    case Finding::not_judged:
      return "not judged";
    case Finding::inaccurate:
      return "inaccurate";
    case Finding::hourglassing:
      return "hourglassing";
    case Finding::locking:
      return "locking";
    case Finding::inverted:
      return "inverted";
    case Finding::unstable:
      return "unstable";
    case Finding::no_equilibrium:
      break;
  }
  return "not at rest";
}

Finding finding_of(Breakdown breakdown) {
  if (breakdown == Breakdown::inverted) return Finding::inverted;
  return breakdown == Breakdown::not_finite ? Finding::unstable : Finding::no_equilibrium;
}

HourglassContent hourglass_content(const Mesh& mesh, const NodalField& u) {
  double hourglass = 0.0, total = 0.0, volume = 0.0;
  for (const auto& cell : mesh.cells) {
    const NodalVectors<double> X = gather(mesh.points, cell), v = gather(u, cell);
    const MeanGradient mean = mean_gradient(X);
    const Matrix<double, 4, 3> q = transpose(hourglass_shape_vectors(X, mean.h)) * v;
    // An eighth of each: Gamma^T Gamma = 8 I, so sum_I |v_I|^2 is an eighth of the squares of all modes.
    hourglass += mean.volume * double_dot(q, q) / 64.0;
    total += share_of_node(mean.volume) * double_dot(v, v);
    volume += mean.volume;
  }
  return {std::sqrt(hourglass / volume), std::sqrt(total / volume)};
}

Symptoms symptoms(const Scene& scene, const NodalField& u, double energy, const NodalField& golden,
                  double unit) {
  const HourglassContent error = hourglass_content(scene.mesh, difference(u, golden));
  const Model element_of_golden(scene, {std::string(golden_method)});
  const double energy_of_golden = strain_energies(element_of_golden, golden).strain;
  const double share = ratio(error.hourglass, error.total);
  const bool moved = largest_imposed(scene) > 0.0;
  return {.error = accuracy(u, golden, nullptr, unit).max_relative_error,
          .zigzag_share = share * share,
          .bending_ratio = ratio(hourglass_content(scene.mesh, u).hourglass,
                                 hourglass_content(scene.mesh, golden).hourglass),
          .stiffness_ratio = moved ? ratio(energy, energy_of_golden) : ratio(energy_of_golden, energy)};
}

Symptoms symptoms(const Scene& scene, const Displacements& u, double energy, const Displacements& golden,
                  double unit) {
  const std::size_t worst = worst_time(u, golden);
  Symptoms result = symptoms(scene, u[worst], energy, golden[worst], unit);
  if (!scene.settings.quasi_static) result.stiffness_ratio = 1.0;
  return result;
}

double good_limit(const std::optional<double>& golden_to_truth) {
  return std::clamp(golden_to_truth.value_or(0.0), 0.01, largest_good_limit);
}

Finding diagnose(const Symptoms& symptoms, double limit) {
  if (symptoms.error <= limit) return Finding::good;
  if (symptoms.bending_ratio >= 1.5 && symptoms.zigzag_share >= 0.1) return Finding::hourglassing;
  const bool stiff = symptoms.stiffness_ratio >= 1.03 && symptoms.bending_ratio <= 1.2;
  return stiff ? Finding::locking : Finding::inaccurate;
}

Finding judge(const Symptoms& symptoms, const std::optional<double>& golden_to_truth) {
  const double limit = good_limit(golden_to_truth);
  const bool within_doubt = symptoms.error > limit && symptoms.error <= golden_to_truth.value_or(0.0);
  return within_doubt ? Finding::not_judged : diagnose(symptoms, limit);
}

}  // namespace sandglass
