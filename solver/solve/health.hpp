#pragma once

#include <span>

namespace sandglass {

/// Whether det F is positive and finite.
bool is_healthy(double jacobian);

/// Throws ComputationError if an element is inverted or its det F is not finite; the error names the step,
/// the first ten such elements with det F, and a remedy. `jacobians` are the smallest det F of each element.
void require_healthy(std::span<const double> jacobians, long step);

}  // namespace sandglass
