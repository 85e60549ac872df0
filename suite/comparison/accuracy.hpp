#pragma once

#include <optional>
#include <vector>

#include "mesh/mesh.hpp"

namespace sandglass {

/// How far displacements are from a reference, as fractions of the unit of displacements.
struct Accuracy {
  double max_relative_error = 0.0;               ///< max over all nodes of |u - u_ref|
  std::optional<double> profile_relative_error;  ///< the same over the nodes of the profile line
  double rms_relative_error = 0.0;               ///< root of the mean square over all nodes
};

/// The accuracy figures of u against a reference on the same nodes; `unit` is the largest imposed
/// displacement, m.
Accuracy accuracy(const NodalField& u, const NodalField& reference, const std::vector<int>* profile,
                  double unit);

}  // namespace sandglass
