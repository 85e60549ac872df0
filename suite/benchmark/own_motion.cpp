#include "benchmark/own_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "solve/central_difference.hpp"
#include "solve/stable_step.hpp"

namespace sandglass {

namespace {

/// A step below this share of the mean step is far shorter than the mean.
constexpr double far_shorter = 0.5;

/// A motion is given up after this multiple of the steps that it would take at the undeformed body's step.
constexpr double most_steps = 100.0;

/// The curve of a load, given over the share of a motion, in the motion's time.
LoadCurve stretched(LoadCurve curve, double duration) {
  for (double& time : curve.times) time *= duration;
  if (curve.formula.evaluate) {
    curve.formula.evaluate = [evaluate = std::move(curve.formula.evaluate), duration](double time) {
      return evaluate(time / duration);
    };
  }
  return curve;
}

/// Records the step and the levels at every check, and ends a motion whose steps shrink too much.
class StepKeeper final : public Observer {
 public:
  StepKeeper(bool adapts, long most, const Proceed& proceed)
      : adapts_(adapts), most_(most), proceed_(proceed) {}

  void history(const HistoryRow& row) override {
    if (row.step_size > 0.0) steps_.push_back(row.step_size);
  }

  /// Frames would add checks, and thus other levels.
  void resumable(const std::function<Checkpoint()>& checkpoint) override {
    if (adapts_) levels_.push_back(std::move(checkpoint().arrays.at("element level")));
  }

  bool proceed(long step, double share, double /*residual*/) override {
    interrupted_ = !proceed_(share);
    too_many_ = step > most_;
    return !interrupted_ && !too_many_;
  }

  bool interrupted() const { return interrupted_; }
  bool too_many() const { return too_many_; }

  /// In the middle of each of `levels_on_the_way` equal numbers of checks, and so of steps.
  std::vector<std::vector<double>> levels() const {
    std::vector<std::vector<double>> some;
    for (std::size_t k = 0; !levels_.empty() && k < levels_on_the_way; ++k) {
      some.push_back(levels_[(2 * k + 1) * levels_.size() / (2 * levels_on_the_way)]);
    }
    return some;
  }

  /// A remark on states whose steps are far shorter than the mean; empty if there are none.
  std::string remark(double mean) const {
    const auto last = steps_.end() - (steps_.empty() ? 0 : 1);  // it ends at the duration
    const auto count =
        std::count_if(steps_.begin(), last, [&](double step) { return step < far_shorter * mean; });
    if (count == 0) return "";
    return fmt::format("{} of {} states need steps as short as {:.2g} ms", count, last - steps_.begin(),
                       1e3 * *std::min_element(steps_.begin(), last));
  }

 private:
  bool adapts_;
  long most_;
  const Proceed& proceed_;
  bool interrupted_ = false, too_many_ = false;
  std::vector<std::vector<double>> levels_;
  std::vector<double> steps_;  // s, at the checks of the run
};

/// The number of steps of a model's motion with the undeformed body's step.
double steps_at_undeformed_step(const Model& model) {
  const DynamicsSettings& dynamics = model.scene().settings.dynamics;
  const NodalField undeformed(model.scene().mesh.points.size());
  return dynamics.duration / (dynamics.step_fraction * stable_step(model, undeformed).step);
}

}  // namespace

double crossing_time(const Scene& scene) {
  double slowest = std::numeric_limits<double>::infinity();  // m/s
  for (const auto& material : scene.materials.list) {
    const double mu = std::visit([](const auto& law) { return law.shear_modulus(); }, material.law);
    slowest = std::min(slowest, std::sqrt(mu / material.density));
  }
  return diagonal(scene.mesh.points) / slowest;
}

Scene in_own_motion(const Scene& scene) {
  if (!scene.settings.quasi_static) return scene;
  Scene moving = in_motion(scene);
  const double crossing = crossing_time(scene), duration = own_motion_crossings * crossing;
  moving.settings.quasi_static = false;
  moving.settings.dynamics = {.duration = duration, .damping = own_motion_damping / crossing, .frames = 1};
  for (auto& curve : moving.curves) curve = stretched(std::move(curve), duration);
  return moving;
}

OwnMotion follow_own_motion(const Scene& scene, MethodChoice choice, const Proceed& proceed,
                            double most_element_steps) {
  const bool adapts = method_named(choice.method).adapts();
  // Steps in float cost two thirds and are as long; but the choice of levels is timed in double.
  choice.precision = adapts ? Precision::double_precision : Precision::single_precision;
  choice.kernel = KernelWidth::pack;
  choice.threads = 1;
  const Scene moving = in_own_motion(scene);
  const DynamicsSettings& dynamics = moving.settings.dynamics;
  const Model model(moving, choice);
  const double steps = steps_at_undeformed_step(model);
  OwnMotion found;
  if (const std::size_t elements = moving.mesh.cells.size();
      static_cast<double>(elements) * steps > most_element_steps) {
    found.remark =
        fmt::format("its motion would take {:.0f} steps of {} elements: not followed", steps, elements);
    return found;
  }
  StepKeeper keeper(adapts, std::lround(most_steps * steps), proceed);
  try {
    Motion motion = integrate(model, keeper);
    if (keeper.interrupted()) throw ComputationError("interrupted; nothing was written");
    const double mean = motion.time / static_cast<double>(std::max(motion.steps, 1L));
    found.remark = keeper.remark(mean);
    if (keeper.too_many()) {
      found.remark = fmt::format("its steps shrink to {:.2g} ms: given up at {:.2g} of {:.2g} s",
                                 1e3 * motion.smallest_step, motion.time, dynamics.duration);
      return found;
    }
    found.mean_step = mean;
    found.end = std::move(motion.u);
    found.levels = keeper.levels();
    found.adaption = motion.adaption_seconds / static_cast<double>(motion.steps);
  } catch (const ComputationError& error) {
    if (keeper.interrupted()) throw;
    const std::string text = error.what();
    found.remark = "its motion fails: " + text.substr(0, text.find('\n'));
  }
  return found;
}

}  // namespace sandglass
