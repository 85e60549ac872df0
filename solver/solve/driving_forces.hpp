#pragma once

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "solve/body.hpp"
#include "solve/loading_curve.hpp"

namespace sandglass {

/// The forces (N) that move the constraints of a body along their paths: reactions plus the inertia of lumped
/// masses; and their works.
template <class Real>
class DrivingForces {
 public:
  /// Body and model must outlive it.
  DrivingForces(const Model& model, const Body<Real>& body)
      : model_(model),
        body_(body),
        forces_(model.scene().constraints.size(), 0.0),
        works_(forces_.size(), 0.0),
        moved_(model.scene().angles.size()),
        accelerations_(moved_.size()) {}

  /// Those of each constraint, and their works (J) since the start; of this rank's own constraints.
  std::vector<double>& forces() { return forces_; }
  std::vector<double>& works() { return works_; }

  /// The sum of the works (J).
  double work() const {
    const std::vector<double> all = body_.constraints().of_all(works_);
    return std::accumulate(all.begin(), all.end(), 0.0);
  }

  /// Moves the paths by a step (s) to a time (s).
  void follow_paths(double time, double step) {
    const DynamicsSettings& settings = model_.scene().settings.dynamics;
    const LoadingCurve now = loading_curve(settings, time), before = loading_curve(settings, time - step);
    const double T = ramp_time(settings);
    for (std::size_t m = 0; m < moved_.size(); ++m) {
      const double angle = model_.scene().angles[m];
      const PathTerms from = path_terms(angle, before.value()), to = path_terms(angle, now.value());
      const PathTerms first = path_rates(angle, now.value()), second = path_accelerations(angle, now.value());
      for (std::size_t i = 0; i < 3; ++i) {
        moved_[m][i] = to[i] - from[i];
        accelerations_[m][i] =
            (now.acceleration() * first[i] + now.rate() * now.rate() * second[i]) / (T * T);
      }
    }
  }

  /// The same between two states of static equilibrium, with these changes of the terms.
  void move(std::vector<PathTerms> moved) {
    moved_ = std::move(moved);
    std::ranges::fill(accelerations_, PathTerms{});
  }

  /// The changes of the terms of each angle's paths over the last step, and their accelerations (1/s^2).
  const std::vector<PathTerms>& moved() const { return moved_; }
  const std::vector<PathTerms>& accelerations() const { return accelerations_; }

  /// Adds the works over the last step, from the mean of the forces at its ends.
  void add_work() {
    for (const std::size_t k : body_.constraints().moving()) {
      const ImposedPath& path = model_.scene().constraints[k].path;
      const double now = force(k);
      works_[k] += 0.5 * (forces_[k] + now) * path.along(moved_[path.angle]);
      forces_[k] = now;
    }
  }

  /// Takes the reactions of the body as they are now.
  void update() {
    for (std::size_t k = 0; k < forces_.size(); ++k) forces_[k] = force(k);
  }

  /// The data that the next step depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    forces_ = body_.constraints().of_all(forces_);
    works_ = body_.constraints().of_all(works_);
    archive("reaction", forces_);
    archive("work", works_);
  }

 private:
  double force(std::size_t k) const {
    const Constraint& constraint = model_.scene().constraints[k];
    const double mass = model_.masses()[at(constraint.node)];
    double sum = body_.reactions()[k];
    for (std::size_t i = 0; i < 3; ++i)
      sum += mass * constraint.path.share[i] * accelerations_[constraint.path.angle][i];
    return sum;
  }

  const Model& model_;
  const Body<Real>& body_;
  std::vector<double> forces_, works_;            // of constraints
  std::vector<PathTerms> moved_, accelerations_;  // of paths of each angle
};

}  // namespace sandglass
