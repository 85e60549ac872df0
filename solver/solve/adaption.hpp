#pragma once

#include <algorithm>

#include "solve/body.hpp"

namespace sandglass {

/// When elements are demoted (promotion is always immediate): never; if a lower level suffices (at the full
/// load); or, to avoid alternating during a motion, if a lower level suffices for half the tolerance.
enum class Demotion { never, where_enough, reluctant };

/// The checks of a dynamic run at which levels are chosen. Choosing them costs about ten steps; it is
/// frequent while elements are promoted, and becomes rarer while none is. With imposed displacements it
/// begins at the first check, since a motion may be short; without them accuracy is relative to displacements
/// that must grow first. Elements are only promoted: one that is demoted when its hourglass modes pass
/// through zero, and promoted again when they are large, would pump energy into every vibration.
class AdaptionSchedule {
 public:
  explicit AdaptionSchedule(bool early) : wait_(early ? 1 : shortest), next_(wait_) {}

  /// Counts a check; returns whether levels are chosen at it.
  bool due() { return ++checks_ >= next_; }

  /// Sets the next check at which levels are chosen, given whether elements were promoted at this one.
  void done(bool promoted) {
    ++choices_;
    const bool begun = wait_ >= shortest;
    wait_ = begun && promoted ? std::max(wait_ / 2, shortest) : std::min(2 * wait_, longest);
    next_ = checks_ + wait_;
  }

  /// The number of times that levels were chosen.
  long choices() const { return choices_; }

  template <class Archive>
  void keep(Archive& archive) {
    archive("checks", checks_);
    archive("judgements", choices_);
    archive("wait for a judgement", wait_);
    archive("next judgement", next_);
  }

 private:
  static constexpr long shortest = 10, longest = 160;

  long checks_ = 0;
  long wait_;
  long next_;
  long choices_ = 0;
};

/// Chooses the levels of the elements of an adaptive method: the error of an element's force may displace its
/// nodes by at most half the requested accuracy. The displacement of a node is estimated with its neighbours
/// fixed, as the force over mu times the integral of |grad N|^2; errors of neighbouring elements and the
/// motion of the rest of the body about double it in most bodies, hence the half. If they add up to more, as
/// along a beam, `promote_for_the_whole` reduces the share. Does nothing for other methods.
template <class Real>
class Adaption {
 public:
  /// For a body of the model, with the accuracy of the model's method choice.
  Adaption(const Model& model, const Body<Real>& body);

  /// Whether the method has levels to choose.
  bool active() const { return active_; }

  /// When to choose them in a motion: early where displacements are imposed.
  AdaptionSchedule schedule() const { return AdaptionSchedule(imposed_ > 0.0); }

  /// Chooses the levels of the elements for the present displacements of a body. Its forces remain those of
  /// the previous levels until they are evaluated again.
  Adaptation apply(Body<Real>& body, Demotion demotion);

  /// If the estimated error of a static answer as a whole exceeds the accuracy, allows elements less error
  /// and promotes them. Returns whether it did.
  bool promote_for_the_whole(Body<Real>& body);

  /// Evaluations of the forces for estimates so far.
  long evaluations_of_estimates() const { return evaluations_of_estimates_; }

  /// The processor time that the calling thread spent on it so far, s.
  double seconds() const { return seconds_; }

 private:
  double asked(const Body<Real>& body) const;
  bool tighten(const Body<Real>& body, double error);

  const Model& model_;
  bool active_;
  double accuracy_;
  double imposed_;       // m, largest
  double share_ = 0.5;   // of the accuracy, allowed to an element
  Rows<Real> mobility_;  // m/N, zero on constrained components
  double seconds_ = 0.0;
  long evaluations_of_estimates_ = 0;
};

extern template class Adaption<double>;
extern template class Adaption<float>;

}  // namespace sandglass
