#pragma once

#include <algorithm>

#include "solve/body.hpp"

namespace sandglass {

/// Elements go up at once. They may go down never, or where they need no more (at rest, at the end of the
/// way), or, so that a motion does not send them up and down, where half as much would do.
enum class Demotion { never, where_enough, reluctant };

/// When levels are chosen anew in a motion, counted in checks. To judge them costs about ten steps: often
/// while elements rise, ever more seldom while none does. Elements only go up: in every vibration one that
/// goes down where its hourglass modes pass through zero, and up again where they are wide, would take energy
/// from nowhere.
class AdaptionSchedule {
 public:
  bool due() { return ++checks_ >= next_; }

  void done(bool rose) {
    wait_ = rose ? std::max(wait_ / 2, shortest) : std::min(2 * wait_, longest);
    next_ = checks_ + wait_;
  }

  template <class Archive>
  void keep(Archive& archive) {
    archive("checks", checks_);
    archive("wait for a judgement", wait_);
    archive("next judgement", next_);
  }

 private:
  static constexpr long shortest = 10, longest = 160;

  long checks_ = 0;
  long wait_ = shortest;
  long next_ = shortest;
};

/// How an adaptive method chooses the levels of its elements while a body moves: an element may displace its
/// nodes by no more than a share of the accuracy asked for. A node yields to a force as if its neighbours
/// stood still, by the force over mu times the integral of |grad N|^2; neighbours that err, too, and the rest
/// of the body make of it about twice as much, whatever the case, hence the half; how near that comes is
/// held in adaptive_test.cpp.
/// Does nothing for other methods.
template <class Real>
class Adaption {
 public:
  Adaption(const Model& model, const Body<Real>& body);

  /// Whether there are levels to choose.
  bool active() const { return active_; }

  /// New levels for the elements of the body as it stands; its forces are those of the old ones until they
  /// are evaluated again.
  Adaptation apply(Body<Real>& body, Demotion demotion);

  /// What that has taken so far.
  double seconds() const { return seconds_; }

 private:
  double largest_displacement(const Body<Real>& body) const;

  bool active_;
  double accuracy_;
  double imposed_;       // m, largest
  Rows<Real> mobility_;  // m/N, zero on constrained components
  double seconds_ = 0.0;
};

extern template class Adaption<double>;
extern template class Adaption<float>;

}  // namespace sandglass
