#pragma once

#include <span>
#include <vector>

#include "material/materials.hpp"

/// The parameters of laws, as their parameters() list them, and differences along them.
namespace sandglass {

/// A difference formula of second order: sum_k weight_k f(x + offset_k h) / h.
struct DifferenceTerm {
  double offset, weight;
};
std::span<const DifferenceTerm> difference_formula(bool upwards);

/// A step of a parameter, and whether it must go upwards, because the parameter is near the least allowed.
struct ParameterStep {
  double length;
  bool upwards;
};

/// Steps of the parameters of a law over which forces vary smoothly and noticeably.
std::vector<ParameterStep> parameter_steps(const AnyLaw& law);

/// A law with a number added to each of its parameters.
AnyLaw with_moved_parameters(AnyLaw law, const std::vector<double>& by);

}  // namespace sandglass
