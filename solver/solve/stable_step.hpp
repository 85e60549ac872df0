#pragma once

#include <span>
#include <vector>

#include "problem/model.hpp"

namespace sandglass {

/// The shortest stable step of the elements of a mesh.
struct StableStep {
  double step;  ///< s
  int element;  ///< which element sets it
};

/// 2 / omega_max of each element (s) at displacements u, with omega_max^2 <= stiffness bound / (rho V / 8).
/// The mesh's largest frequency is never above the largest of its elements', so the smallest of these steps
/// is safe.
std::vector<double> stable_steps(const Model& model, const NodalField& u);

/// The smallest of them.
StableStep stable_step(const Model& model, const NodalField& u);

/// The same from bounds of the elements' stiffness (N/m) that are known already.
StableStep stable_step(const Model& model, std::span<const double> stiffness_bounds);

}  // namespace sandglass
