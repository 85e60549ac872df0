#include <fmt/format.h>

#include "solve/relaxation.hpp"

namespace sandglass {

bool in_equilibrium(const Relaxation& relaxation) {
  return relaxation.converged || relaxation.rounded;
}

std::string stability_text(const Relaxation& relaxation) {
  if (relaxation.stability == Stability::stable) return "stable";
  if (relaxation.stability == Stability::saddle_left) return "stable, after an unstable one was left";
  return "stability not decided: " + relaxation.why_not_decided;
}

std::string outcome(const Relaxation& relaxation, Precision precision) {
  if (relaxation.converged) return "at rest";
  const std::string evaluations =
      fmt::format("{} evaluation{}", relaxation.steps, relaxation.steps == 1 ? "" : "s");
  if (relaxation.interrupted) return fmt::format("interrupted after {}", evaluations);
  if (!relaxation.stagnated) {
    return fmt::format("not at rest after {}{}", evaluations,
                       relaxation.inverted ? ", and elements are inverted" : "");
  }
  if (in_equilibrium(relaxation))
    return fmt::format("at rest within the rounding of {} precision",
                       precision == Precision::single_precision ? "single" : "double");
  return fmt::format("not at rest: residual stopped falling at {:.1e}", relaxation.residual);
}

}  // namespace sandglass
