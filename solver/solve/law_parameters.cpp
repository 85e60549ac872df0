#include "solve/law_parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sandglass {

namespace {

constexpr std::array<DifferenceTerm, 2> central{{{-1.0, -0.5}, {1.0, 0.5}}};
constexpr std::array<DifferenceTerm, 3> forward{{{0.0, -1.5}, {1.0, 2.0}, {2.0, -0.5}}};

/// How far parameters are moved, over the scale on which laws vary with them. Its square is the error; a
/// shorter step would lose parameters that act on small strains only in the rounding of the others' forces.
constexpr double share_of_scale = 1e-4;

template <class P>
ParameterStep step_of(const P& parameter, double value, double shear_modulus) {
  constexpr double near = 0.1;
  const Range& range = parameter.range;
  const double below = value - range.low, above = range.high - value;
  const double unit = parameter.unit == "Pa" ? shear_modulus : 1.0;
  if (!range.low_open && below < near * unit) return {share_of_scale * std::min(unit, above), true};
  const double scale = std::min(below, above);
  return {share_of_scale * (std::isfinite(scale) ? scale : std::max(std::abs(value), unit)), false};
}

double shear_modulus(const AnyLaw& any_law) {
  return std::visit([](const auto& law) { return law.shear_modulus(); }, any_law);
}

}  // namespace

std::span<const DifferenceTerm> difference_formula(bool upwards) {
  return upwards ? std::span<const DifferenceTerm>(forward) : central;
}

std::vector<ParameterStep> parameter_steps(const AnyLaw& law) {
  const double modulus = shear_modulus(law);
  std::vector<ParameterStep> steps;
  AnyLaw copy = law;
  for_each_parameter(copy, [&](const auto& p, double value) { steps.push_back(step_of(p, value, modulus)); });
  return steps;
}

AnyLaw with_moved_parameters(AnyLaw law, const std::vector<double>& by) {
  std::size_t k = 0;
  for_each_parameter(law, [&](const auto&, double& value) { value += by[k++]; });
  return law;
}

}  // namespace sandglass
