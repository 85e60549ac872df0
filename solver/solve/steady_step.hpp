#pragma once

namespace sandglass {

/// The step of a motion, which changes rarely. Central differences of a constant step keep an energy close
/// to the body's own, and every change of the step changes which. Changes in time with a vibration, shorter
/// in compression and longer in extension, would feed it without limit. So a step is shortened when it must
/// be, which a cautious first step makes rare, and lengthened only where all of a waiting time allows it.
/// After each time the wait is twice as long, up to the time in which damping takes what a change brought.
class SteadyStep {
 public:
  /// The first step over the longest allowed: nearer to 1, the first compression shortens it, which brings
  /// more energy than all later changes.
  static constexpr double first_share = 0.7;

  /// `damping` is mass-proportional, 1/s.
  explicit SteadyStep(double damping);

  /// The present step (s), 0 before the first.
  double step() const { return step_; }

  /// The next step (s) at `time` (s), where `longest` (s) is allowed.
  double next(double longest, double time);

  /// Whether steps may still prove too long: once they are a fifth of what is allowed, they are not the
  /// cause.
  bool may_shorten() const { return share_ > 0.2; }

  /// Shortens the present step, and all that are allowed later, since they proved too long.
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
  double share_ = 1.0;   // of what is said to be allowed
};

}  // namespace sandglass
