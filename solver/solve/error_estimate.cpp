#include "solve/error_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "solve/equilibrium.hpp"
#include "solve/health.hpp"

namespace sandglass {

double rms_distance(const NodalField& a, const NodalField& b) {
  double squares = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) squares += std::pow(distance(a[n], b[n]), 2);
  return std::sqrt(squares / static_cast<double>(a.size()));
}

ErrorEstimate estimate_error(const Model& model, const NodalField& u) {
  constexpr double share_left = 0.01;
  const Scene& scene = model.scene();
  if (remember_path(scene.forces))
    throw ComputationError("friction depends on the path, which the answer does not show: no estimate");
  const Model exact(scene, {.method = std::string(estimate_method),
                            .threads = model.choice().threads,
                            .ranks = model.choice().ranks});
  const auto& elements = *std::get<std::unique_ptr<InternalForce<double>>>(exact.internal_force());
  Equilibrium<double> search(exact, elements);
  search.body().state() = state_at(elements, u);
  search.body().impose(1.0);
  if (!is_healthy(search.body())) {
    throw ComputationError("the mean-dilatation element is inverted at this answer: no estimate");
  }
  search.take_own_pressures();
  search.start(Effort::full);
  const double enough = std::max(share_left * search.residual(), scene.settings.relaxation.tolerance);
  while (search.residual() > enough) {
    if (!search.step()) {
      throw ComputationError(
          "the mean-dilatation element's forces are not finite near this answer: no estimate");
    }
  }
  const NodalField better = search.body().field(search.body().state().u);
  return {.largest = largest_distance(better, u),
          .rms = rms_distance(better, u),
          .evaluations = search.evaluations()};
}

}  // namespace sandglass
