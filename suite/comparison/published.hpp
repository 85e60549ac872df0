#pragma once

#include <optional>
#include <vector>

#include "comparison/comparison.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// A published motion and the computed one.
struct PublishedResult {
  PublishedValue published;
  std::optional<double> computed;  ///< m or rad; none if the computation failed
  std::optional<double> truth;     ///< m or rad, of the stored truth; none without one

  /// computed / published.
  std::optional<double> ratio() const;

  /// computed / truth.
  std::optional<double> ratio_to_truth() const;
};

/// The motion for which a value is published, computed from displacements u (m): the mean of a component over
/// its node set (m), or the best-fitting small rotation (rad) about an axis through the middle of the set,
/// sum (r x u)_k / sum (|r|^2 - r_k^2).
double motion_of(const Scene& scene, const NodalField& u, const PublishedValue& published);

/// The published values of a scene, with those of its truth if there is one; nothing is computed yet.
std::vector<PublishedResult> published_results(const Scene& scene, const std::vector<PublishedValue>& values,
                                               const std::optional<NodalField>& truth);

/// Fills in the values computed from displacements u (m) of the scene.
void fill_computed(const Scene& scene, const NodalField& u, std::vector<PublishedResult>& results);

/// The largest |computed / published - 1|; none if there is nothing to compare.
std::optional<double> largest_relative_error(const std::vector<PublishedResult>& results);

}  // namespace sandglass
