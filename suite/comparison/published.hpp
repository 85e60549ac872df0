#pragma once

#include <optional>
#include <vector>

#include "comparison/accuracy.hpp"
#include "comparison/comparison.hpp"
#include "problem/model.hpp"
#include "problem/observer.hpp"

namespace sandglass {

/// The weights with which the displacements of nodes add up to that of a point (m) that moves with them: that
/// of the linear field nearest to theirs, by least squares. None for a point outside the line, plane or space
/// that the nodes span.
std::optional<std::vector<double>> point_weights(const NodalField& points, const std::vector<int>& nodes,
                                                 const Vector& at);

/// A published motion and the computed one.
struct PublishedResult {
  PublishedValue published;
  std::optional<double> computed;  ///< m, rad, s or N; none if the computation failed
  std::optional<double> truth;     ///< m or rad, of the stored truth; none without one
  std::optional<double> golden;    ///< of the stored golden; none without one

  /// computed / published.
  std::optional<double> ratio() const;

  /// computed / truth.
  std::optional<double> ratio_to_truth() const;
};

/// The motion for which a value is published, computed from displacements u (m): the mean of a component over
/// its node set or at a point that moves with it (m), or the best-fitting small rotation (rad) about an axis
/// through the middle of the set, sum (r x u)_k / sum (|r|^2 - r_k^2).
double motion_of(const Scene& scene, const NodalField& u, const PublishedValue& published);

/// The value itself: that motion at the end, or its first peak or period, from displacements u (m) at the
/// times of an answer of the scene. An extremum is that of a parabola through three frames. None if there is
/// none.
std::optional<double> computed_value(const Scene& scene, const Displacements& u,
                                     const PublishedValue& published);

/// The published values of a scene, with those of its truth and golden if it has them; nothing is computed
/// yet.
std::vector<PublishedResult> published_results(const Scene& scene, const std::vector<PublishedValue>& values,
                                               const std::optional<Displacements>& truth,
                                               const std::optional<Displacements>& golden);

/// The reactions (N) of an answer at a check; see HistoryRow.
struct ReactionsAt {
  double time;  ///< s; in static equilibrium, as of a HistoryRow
  Reactions reactions;
};

/// The force (N) for which a value is published, from the reactions at all checks: the sum over its
/// obstacles, at the last check or its mean in time; none without a check.
std::optional<double> force_of(const std::vector<ReactionsAt>& checks, const PublishedValue& published);

/// Fills in the values computed from displacements u (m) of the scene and from the reactions at its checks.
void fill_computed(const Scene& scene, const Displacements& u, const std::vector<ReactionsAt>& checks,
                   std::vector<PublishedResult>& results);

/// The largest |computed / published - 1| of published or measured values, and either of periods or of the
/// others; none if there is nothing to compare.
std::optional<double> largest_relative_error(const std::vector<PublishedResult>& results,
                                             bool measured = false, bool periods = false);

}  // namespace sandglass
