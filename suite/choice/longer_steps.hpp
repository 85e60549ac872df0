#pragma once

#include <string>
#include <vector>

#include "problem/make_scene.hpp"

namespace sandglass {

/// A case with longer steps.
struct LongerSteps {
  std::string difference;  ///< "body_frequency", or "body_frequency, bulk / 2.5"
  CaseOnMesh problem;
};

/// Cases of the same motion with longer steps, starting with the closest to the case: first, unless the case
/// has them, steps by the largest frequency of the body instead of its elements; then also softer bulk
/// moduli. A material with Young's modulus E and Poisson's ratio nu is softened as long as nu stays at .25 or
/// more: 1 - 2 nu is multiplied by 1.5, 2.5, 5 and 10, and E by sqrt((1 + nu) / (1 + nu')). The root was
/// found by trial: with it the frequency of a clamped beam hardly changes. None if the case uses subcycles,
/// which exclude steps by the frequency of the body.
std::vector<LongerSteps> longer_steps(const CaseOnMesh& problem);

}  // namespace sandglass
