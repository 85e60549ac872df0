#pragma once

#include <optional>
#include <vector>

#include "mesh/mesh.hpp"

namespace sandglass {

/// Distances of displacements from a reference, as fractions of the unit of displacements.
struct Accuracy {
  double max_relative_error = 0.0;               ///< max over all nodes of |u - u_ref|
  std::optional<double> profile_relative_error;  ///< the same over the nodes of the profile line
  double rms_relative_error = 0.0;               ///< root of the mean square over all nodes
};

/// Displacements (m) at the times of an answer: one field in static equilibrium, several in motion.
using Displacements = std::vector<NodalField>;

/// The accuracy figures of u against a reference on the same nodes; `unit` is the largest imposed
/// displacement, m.
Accuracy accuracy(const NodalField& u, const NodalField& reference, const std::vector<int>* profile,
                  double unit);

/// The same over time: the largest of each figure.
Accuracy accuracy(const Displacements& u, const Displacements& reference, const std::vector<int>* profile,
                  double unit);

/// The index of the time at which u is farthest from a reference.
std::size_t worst_time(const Displacements& u, const Displacements& reference);

}  // namespace sandglass
