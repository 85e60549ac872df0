#pragma once

#include <span>

namespace sandglass {

/// Whether a det F is that of a body: positive and finite.
bool is_healthy(double jacobian);

/// Throws ComputationError when an element is inverted or its det F is not finite: names the step, the
/// first ten such elements with det F, and a remedy. `jacobians` holds the smallest det F of each element.
void require_healthy(std::span<const double> jacobians, long step);

}  // namespace sandglass
