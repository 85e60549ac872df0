#pragma once

#include <array>
#include <cmath>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "material/laws.hpp"

namespace sandglass::verification {

/// Poisson's ratios of every test that sweeps them: compressible, soft tissue, nearly incompressible.
inline constexpr std::array<double, 4> poisson_ratios{0.25, 0.45, 0.49, 0.499};

inline constexpr double sample_young_modulus = 3000.0;

/// A sensible value for a parameter that a law declares: known names get values that give the moduli of E and
/// nu at small strain; an unknown one in Pa gets E, any other the middle of its range. New laws need no edit
/// here.
inline double sample_value(std::string_view name, std::string_view unit, const Range& range, double E,
                           double nu) {
  const double mu = E / 2.0 / (1.0 + nu);
  if (name == "young_modulus") return E;
  if (name == "poisson_ratio") return nu;
  if (name == "shear_modulus") return mu;
  if (name == "bulk_modulus") return E / 3.0 / (1.0 - 2.0 * nu);
  // Mooney-Rivlin: mu = 2 (c10 + c01). Yeoh: mu = 2 c1, and signs such that the law softens and stiffens.
  if (name == "c10" || name == "c01") return mu / 4.0;
  if (name == "c1") return mu / 2.0;
  if (name == "c2") return -mu / 20.0;
  if (name == "c3") return mu / 100.0;
  // Ogden: mu = mu1 + mu2, brain tissue's exponent and one that stiffens in stretch. With a larger share of
  // the former, uniform stretch of elements without hourglass control is no stable equilibrium.
  if (name == "mu1") return 0.4 * mu;
  if (name == "mu2") return 0.6 * mu;
  if (name == "alpha1") return -4.7;
  if (name == "alpha2") return 5.0;
  // Guccione: a tenth of heart muscle's exponents (Land et al. 2015), since tests stretch to five times the
  // length, where exp(Q) would overflow.
  if (name == "b_fibre") return 0.8;
  if (name == "b_transverse") return 0.2;
  if (name == "b_shear") return 0.4;
  // Holzapfel and Ogden: matrix, fibres, sheets and their shear, each with a stiffness of its own.
  if (name == "a") return mu / 2.0;
  if (name == "a_f") return mu;
  if (name == "a_s") return mu / 2.0;
  if (name == "a_fs") return mu / 4.0;
  if (name == "b" || name == "b_f" || name == "b_s" || name == "b_fs") return 0.1;
  // Brain tissue: Miller and Chinzei 2002, J. Biomech. 35:483.
  if (name == "relaxation_1") return 0.450;
  if (name == "time_1") return 0.50;
  if (name == "relaxation_2") return 0.365;
  if (name == "time_2") return 50.0;
  if (unit == "Pa") return E;
  if (std::isfinite(range.low) && std::isfinite(range.high)) return 0.5 * (range.low + range.high);
  return std::isfinite(range.low) ? range.low + 1.0 : 1.0;
}

/// A law of the list with sensible parameters, from its own declarations. The entries of a vector differ, so
/// that a direction is none of the axes.
template <class Law>
Law sample_law(double poisson_ratio, double young_modulus = sample_young_modulus) {
  Law law;
  const auto set = [&](const auto& parameter) {
    auto& member = law.*(parameter.member);
    const double value =
        sample_value(parameter.name, parameter.unit, parameter.range, young_modulus, poisson_ratio);
    if constexpr (std::is_arithmetic_v<std::remove_reference_t<decltype(member)>>) {
      member = value;
    } else {
      double divisor = 1.0;
      for (auto& entry : member) entry = value / divisor++;
    }
  };
  std::apply([&](const auto&... parameter) { (set(parameter), ...); }, Law::parameters());
  return law;
}

/// Young's modulus (Pa) of any law at small strain.
template <class Law>
double young_modulus_of(const Law& law) {
  const double mu = law.shear_modulus();
  const double K = law.bulk_modulus();
  return 9.0 * K * mu / (3.0 * K + mu);
}

/// lambda + 2 mu at small strain, Pa.
template <class Law>
double p_wave_modulus(const Law& law) {
  return lame_lambda(law) + 2.0 * law.shear_modulus();
}

}  // namespace sandglass::verification
