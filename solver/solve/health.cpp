#include "solve/health.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"

namespace sandglass {

bool is_healthy(double jacobian) {
  return std::isfinite(jacobian) && jacobian > 0.0;
}

void require_healthy(std::span<const double> jacobians, long step) {
  std::string listed;
  int ill = 0;
  bool finite = true;
  for (std::size_t e = 0; e < jacobians.size(); ++e) {
    if (is_healthy(jacobians[e])) continue;
    finite = finite && std::isfinite(jacobians[e]);
    if (++ill <= 10) listed += fmt::format("\n  element {}: det F = {:.4g}", e, jacobians[e]);
  }
  if (ill == 0) return;
  const std::string text = fmt::format(
      "step {}: {} of {} elements {}; det F must be positive\n"
      "the first {}:{}\n"
      "remedy: {}",
      step, ill, jacobians.size(), finite ? "are inverted" : "are no longer finite", std::min(ill, 10),
      listed,
      finite ? "impose less displacement or more slowly (levels, ramp_time), refine the mesh, or use an "
               "hourglass "
               "control (method tl-perturbation or tl-mean-dilatation)"
             : "take a smaller step (step_fraction, time_step) or check more often (check_interval)");
  throw ComputationError(text, finite ? Breakdown::inverted : Breakdown::not_finite);
}

}  // namespace sandglass
