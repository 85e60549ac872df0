#pragma once

#include <fmt/format.h>

#include "base/error.hpp"
#include "solve/resident.hpp"

namespace sandglass {

/// The steps of a simulation on the processor of its elements, where the body stays between calls. A copy
/// takes steps of another body of the same model, and starts by leaving that there.
template <class Real>
class DeviceSteps {
 public:
  /// The model must outlive the steps. Throws InputError if its state cannot stay there.
  explicit DeviceSteps(const Model& model) : model_(model) {
    if (!active()) return;
    if (const std::string reason = why_not_resident(model.scene()); !reason.empty()) {
      throw InputError(fmt::format(
          "device: the state of a simulation stays there, which this scene's cannot: {}; allowed: scenes "
          "without that, or the device cpu",
          reason));
    }
  }
  DeviceSteps(const DeviceSteps& other) : model_(other.model_) {}
  DeviceSteps& operator=(const DeviceSteps&) = delete;
  ~DeviceSteps() = default;

  /// Whether steps are taken there, and not here.
  bool active() const { return model_.choice().processor != nullptr; }

  /// The body has changed here: the next steps start from that.
  void begin_anew() { current_ = false; }

  /// Starts steps in which constraints move straight from one displacement (m) to another.
  void start(const Leapfrog<Real>& leapfrog, std::span<const double> from, std::span<const double> to) {
    if (motion_ == nullptr) {
      const auto& elements = std::get<std::unique_ptr<InternalForce<Real>>>(model_.internal_force());
      motion_ = resident_motion(model_, *elements, leapfrog);
    }
    if (!current_) motion_->begin(leapfrog.body(), {});
    current_ = true;
    std::vector<typename NodalProblem<Real>::Share> shares;
    for (std::size_t k = 0; k < from.size(); ++k) shares.push_back({from[k], to[k] - from[k], 0.0});
    motion_->redirect(shares);
  }

  /// Collects a step of `step` s that ends at a share of that path, with these factors of loads there.
  void add(LeapfrogClock::Coefficients coefficients, double step, double share, std::vector<double> factors) {
    const ResidentStep::Angle straight{{1.0, share, 0.0}, {}, {}};  // without works, which nobody reads
    motion_->add({coefficients.keep, coefficients.gain, step, std::move(factors),
                  std::vector(model_.scene().angles.size(), straight)});
  }

  /// Whether the elements are healthy after the steps.
  bool is_healthy() { return motion_->is_healthy(); }

  /// Brings the body here, at a time (s) and load factor; it stays there, too.
  void bring(Body<Real>& body, double factor, double time) {
    std::vector<double> none;
    motion_->bring(body, factor, time, none, none);
  }

 private:
  const Model& model_;
  std::unique_ptr<ResidentMotion<Real>> motion_;  // null before the first step
  bool current_ = false;                          // whether the body is there
};

}  // namespace sandglass
