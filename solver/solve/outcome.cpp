#include <fmt/format.h>

#include "solve/relaxation.hpp"

namespace sandglass {

bool in_equilibrium(const Relaxation& relaxation) {
  return relaxation.converged || relaxation.rounded;
}

std::string stability_text(const Relaxation& relaxation) {
  if (relaxation.stability == Stability::stable) return "stable";
  if (relaxation.stability == Stability::saddle_left) return "stable, reached from an unstable one";
  return "stability not decided: " + relaxation.why_not_decided;
}

std::string outcome(const Relaxation& relaxation, Precision precision) {
  if (relaxation.converged) return "static equilibrium";
  const std::string evaluations =
      fmt::format("{} evaluation{}", relaxation.steps, relaxation.steps == 1 ? "" : "s");
  if (relaxation.interrupted) return fmt::format("interrupted after {}", evaluations);
  if (!relaxation.stagnated) {
    return fmt::format("no equilibrium after {}{}", evaluations,
                       relaxation.inverted ? ", and elements are inverted" : "");
  }
  if (in_equilibrium(relaxation))
    return fmt::format("static equilibrium within the rounding of {} precision",
                       precision == Precision::single_precision ? "single" : "double");
  return fmt::format("no equilibrium: residual stopped falling at {:.1e}", relaxation.residual);
}

}  // namespace sandglass
