#pragma once

namespace sandglass {

/// The step of a motion, which changes rarely. With a constant step, central differences conserve an energy
/// close to the body's own, and every change of the step changes that energy. Changes in phase with a
/// vibration, shorter in compression and longer in extension, would feed it without limit. So a step is
/// shortened only if it must be, which a cautious first step makes rare, and lengthened only if a whole
/// waiting time allows it. Each wait is twice as long as the last, up to the time in which damping removes
/// the energy of a change.
class SteadyStep {
 public:
  /// The first step over the longest allowed: closer to 1, the first compression would shorten it, which adds
  /// more energy than all later changes.
  static constexpr double first_share = 0.7;

  /// `damping` is mass-proportional, 1/s.
  explicit SteadyStep(double damping);

  /// The current step (s), 0 before the first.
  double step() const { return step_; }

  /// The next step (s) at `time` (s), at most `longest` (s).
  double next(double longest, double time);

  /// Whether steps may still be too long: once they are a fifth of the allowed length, they are not the
  /// cause.
  bool may_shorten() const { return share_ > 0.2; }

  /// Shortens the current step and all later ones, because they proved too long.
  void shorten();

  /// The data that the next call depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    archive("steady step", step_);
    archive("least longest step", least_);
    archive("steady since", since_);
    archive("steady wait", wait_);
    archive("steady share", share_);
  }

 private:
  double longest_wait_;  // s
  double step_ = 0.0;    // s
  double least_ = 0.0;   // s, of the longest steps allowed since
  double since_ = 0.0;   // s, the start of the wait
  double wait_ = 0.0;    // s
  double share_ = 1.0;   // of the allowed step
};

}  // namespace sandglass
