#pragma once

#include <span>

namespace sandglass {

/// Throws ComputationError when an element is inverted or its det F is not a number: names the step, the
/// first ten such elements with det F, and a remedy. `jacobians` holds the smallest det F of each element.
void require_healthy(std::span<const double> jacobians, long step);

}  // namespace sandglass
