#pragma once

#include <algorithm>
#include <cmath>

namespace sandglass {

/// The scalars of nonlinear conjugate gradients with one force evaluation per step. Storage, number type and
/// preconditioner P are the caller's: sums over nodes come in, coefficients of the nodal updates go out.
///
/// The force f is evaluated at the trial u + length() p. From d = f - g, its secant along p, follows where
/// the slope vanishes; force and displacement are moved there without another evaluation, and the next
/// direction follows:
///   g <- g + move() d,   u <- u + move() length p,   p <- turn() p - P g.
/// This is exact for a force that is linear along p. The error due to nonlinearity decays: each step
/// multiplies the error of g by 1 - move(), and a trial with move() below 1/3 or above 3 is repeated with a
/// better length. turn() is that of Polak and Ribiere, at least zero (Nocedal and Wright 2006, section 5.2).
class ConjugateGradient {
 public:
  /// What to do after a trial.
  enum class Action {
    move,   ///< update u, g and p
    retry,  ///< keep u, g and p, and evaluate at the new length()
    fail    ///< no length along p gives finite forces
  };

  /// Sums over nodes after an evaluation.
  struct TrialSums {
    double p_d = 0.0;
    double g_P_d = 0.0;
    double d_P_d = 0.0;
    TrialSums& operator+=(const TrialSums& other) {
      p_d += other.p_d;
      g_P_d += other.g_P_d;
      d_P_d += other.d_P_d;
      return *this;
    }
  };

  /// Sums over nodes after an update.
  struct DirectionSums {
    double g_p = 0.0;
    double g_P_g = 0.0;
    DirectionSums& operator+=(const DirectionSums& other) {
      g_p += other.g_p;
      g_P_g += other.g_P_g;
      return *this;
    }
  };

  /// Length of the next trial, in directions p.
  double length() const { return length_; }
  double move() const { return move_; }
  double turn() const { return turn_; }

  /// Sets the sums of the updated direction.
  void take(const DirectionSums& sums) { direction_ = sums; }

  /// The next action after a trial; sets length(), move() and turn().
  Action assess(const TrialSums& sums) {
    if (!std::isfinite(sums.p_d) || !std::isfinite(sums.d_P_d)) return retry(1.0 / farthest);
    if (direction_.g_p >= 0.0 || sums.p_d <= 0.0) {
      restart();
      return Action::move;
    }
    move_ = -direction_.g_p / sums.p_d;
    if ((move_ < 1.0 / 3.0 || move_ > 3.0) && retries_ < most_retries) {
      return retry(std::clamp(move_, 1.0 / farthest, farthest));
    }
    move_ = std::min(move_, 3.0);
    turn_ = std::max(0.0, move_ * (sums.g_P_d + move_ * sums.d_P_d) / direction_.g_P_g);
    length_ *= move_;
    retries_ = 0;
    return Action::move;
  }

 private:
  static constexpr double farthest = 8.0;  ///< largest change of length between two trials
  static constexpr int most_retries = 6;

  /// Steepest descent from the trial, if there is no minimum along p.
  void restart() {
    move_ = 1.0;
    turn_ = 0.0;
    length_ = std::min(length_, 1.0);
    retries_ = 0;
  }

  Action retry(double factor) {
    length_ *= factor;
    return ++retries_ > most_retries ? Action::fail : Action::retry;
  }

  DirectionSums direction_;
  double length_ = 1.0;
  double move_ = 1.0;
  double turn_ = 0.0;
  int retries_ = 0;
};

/// Detects that a residual has reached the roundoff of the number type: it is below ten thousand epsilon, and
/// has not halved in 50 evaluations.
class Stagnation {
 public:
  /// `epsilon` is the number type's.
  explicit Stagnation(double epsilon) : reachable_(1e4 * epsilon) {}

  /// Records the residual of another evaluation.
  void take(double residual) {
    ++waited_;
    if (residual < 0.5 * halved_) {
      halved_ = residual;
      waited_ = 0;
    }
  }

  bool reached() const { return halved_ < reachable_ && waited_ >= 50; }

 private:
  double reachable_;
  double halved_ = INFINITY;  ///< the residual when it last halved
  long waited_ = 0;
};

}  // namespace sandglass
