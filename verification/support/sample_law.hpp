#pragma once

#include <array>
#include <tuple>

#include "material/laws.hpp"

namespace sandglass::verification {

/// Poisson's ratios of every test that sweeps them: compressible, soft tissue, nearly incompressible.
inline constexpr std::array<double, 4> poisson_ratios{0.25, 0.45, 0.49, 0.499};

inline constexpr double sample_young_modulus = 3000.0;

/// A law of the list with sensible parameters, from its own declarations: known names get the usual numbers,
/// a new parameter the middle of its range, so that a new law is tested without an edit here.
template <class Law>
Law sample_law(double poisson_ratio, double young_modulus = sample_young_modulus) {
  Law law;
  const auto value_of = [&](std::string_view name, const Range& range) {
    if (name == "young_modulus") return young_modulus;
    if (name == "poisson_ratio") return poisson_ratio;
    if (name == "shear_modulus") return young_modulus / 2.0 / (1.0 + poisson_ratio);
    if (name == "bulk_modulus") return young_modulus / 3.0 / (1.0 - 2.0 * poisson_ratio);
    // Ogden's terms share the shear modulus: brain tissue's exponent beside one that stiffens in stretch.
    // With more of the former, uniform stretch of elements without hourglass control is no stable
    // equilibrium.
    if (name == "mu1") return 0.4 * young_modulus / 2.0 / (1.0 + poisson_ratio);
    if (name == "mu2") return 0.6 * young_modulus / 2.0 / (1.0 + poisson_ratio);
    if (name == "alpha1") return -4.7;
    if (name == "alpha2") return 5.0;
    if (std::isfinite(range.low) && std::isfinite(range.high)) return 0.5 * (range.low + range.high);
    return std::isfinite(range.low) ? range.low + 1.0 : 1.0;
  };
  std::apply(
      [&](const auto&... parameter) {
        ((law.*(parameter.member) = value_of(parameter.name, parameter.range)), ...);
      },
      Law::parameters());
  return law;
}

/// Young's modulus at rest (Pa) of any law.
template <class Law>
double young_modulus_of(const Law& law) {
  const double mu = law.shear_modulus();
  const double K = law.bulk_modulus();
  return 9.0 * K * mu / (3.0 * K + mu);
}

/// lambda + 2 mu at rest, Pa.
template <class Law>
double p_wave_modulus(const Law& law) {
  return lame_lambda(law) + 2.0 * law.shear_modulus();
}

}  // namespace sandglass::verification
