#include "solve/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/row_loops.hpp"
#include "solve/health.hpp"
#include "solve/linearized.hpp"
#include "solve/newton_step.hpp"

namespace sandglass {

namespace {

/// If the norm is below this share of its initial value, accelerated steps find the answer, even if slowly,
/// unless an element is inverted.
constexpr double near_answer = 0.01;

/// The method of multipliers ends when the norm has fallen to this share; after leaving a saddle it ends
/// later, as accelerated steps would return there.
constexpr double multiplied_share = 0.1, multiplied_share_from_saddle = 1e-4;

/// It may hand over to accelerated steps this often before the descent of the potential begins.
constexpr int most_returns = 2;

/// The elements' own resistance to volume changes beside multipliers, over the shear modulus.
constexpr double penalty_over_shear = 5.0;

/// Evaluations for one Newton step.
constexpr int most_products_with_multipliers = 200, most_products = 500;

/// Accelerated steps after which the configuration may have changed too much for the multigrid method, and
/// the norm, over its initial value, below which that no longer matters.
constexpr std::size_t steps_between_updates = 8;
constexpr double close_enough = 1e-4;

/// The norm after an accelerated step may be at most this multiple of the largest of the last ones; longer
/// steps are shortened. With a larger value, bodies that bend and stretch far diverge. With a smaller one,
/// some searches end that would recover with full effort, or with forces that depend on the path, which
/// remembers every detour.
constexpr double most_growth = 1.5, most_growth_of_the_last_try = 3.0;

/// The nodes that touch obstacles are updated when the norm has fallen to this share. Where that does not
/// leave fewer nodes whose contact is contrary, the next update waits for a tenth of that, until the share is
/// the least.
constexpr double updated_share = 0.3, least_updated_share = 1e-3;

/// They are updated after this many steps at the latest.
constexpr int steps_between_contacts = 5;

/// This many updates may fail to leave fewer such nodes; then only one of them is changed at a time, until
/// they are fewer, which excludes cycles (Portugal, Judice and Vicente 1994).
constexpr int most_failed_updates = 3;

/// Further updates do not count as progress, if shorter increments may help (brief) or not.
constexpr int most_updates = 100, most_brief_updates = 50;

/// A saddle is left by this change of displacement gradients, doubled repeatedly. Directions whose potentials
/// differ by less than this share of their fall count as equal; the first is taken.
constexpr double shortest_leap = 1e-3, hardly_lower = 1e-5;

}  // namespace

template <class Real>
bool Equilibrium<Real>::Progress::take(double norm, const Patience& patience) {
  if (norm < patience.share * fallen) {
    fallen = norm;
    waited = 0;
  }
  return ++waited <= patience.steps;
}

template <class Real>
void Equilibrium<Real>::take_own_pressures() {
  mixed_.linearize();
  mixed_.take_own_pressures();
}

template <class Real>
void Equilibrium<Real>::begin() {
  mixed_.linearize();
  mixed_.set_drags();
  mixed_.weigh();
}

template <class Real>
void Equilibrium<Real>::start(Effort effort) {
  effort_ = effort;
  leaves_saddle_ = false;
  convex_ = true;
  returns_ = 0;
  body().fix_contact(Fixing::none);
  begin();
  mixed_.evaluate();
  first_ = mixed_.norm();
  if (mixed_.pressure_varies()) {
    begin_descent();
  } else {
    begin_acceleration();
    start_ = best_;
  }
}

template <class Real>
bool Equilibrium<Real>::step() {
  switch (stage_) {
    case Stage::acceleration:
      return accelerated();
    case Stage::multipliers:
      return multiplied();
    case Stage::descent:
      return descended();
  }
  return false;
}

template <class Real>
void Equilibrium<Real>::begin_acceleration() {
  stage_ = Stage::acceleration;
  body().fix_contact(Fixing::all);
  contact_ = {mixed_.norm(), updated_share};
  acceleration_.clear();
  norms_.clear();
  best_norm_ = mixed_.norm();
  if (effort_ == Effort::full) best_ = {body().state(), pressures()};
  progress_ = {best_norm_};
}

template <class Real>
bool Equilibrium<Real>::accelerated() {
  if (mixed_.norm() < contact_.share * contact_.norm || ++contact_.steps > steps_between_contacts)
    update_contact();
  const double norm = mixed_.norm();
  if (effort_ == Effort::full && norm < best_norm_) {
    best_norm_ = norm;
    best_ = {body().state(), pressures()};
  }
  const bool near = !norms_.empty() && norm < near_answer * norms_.front() && is_healthy(body());
  const bool patient = near || effort_ == Effort::patient;
  if (progress_.take(norm, patient ? patient_patience : accelerated_patience) && linearized_step())
    return true;
  if (effort_ != Effort::full) return false;
  if (returns_++ < most_returns) {
    begin_multipliers();
  } else {
    go_to_lower();
    begin_descent();
  }
  return true;
}

template <class Real>
void Equilibrium<Real>::update_contact() {
  const int contrary = body().touch().contrary;
  if (contrary == 0) return;
  if (contrary < contact_.fewest) {
    contact_.fewest = contrary;
    contact_.failed = 0;
  } else {
    ++contact_.failed;
    contact_.share = std::max(0.1 * contact_.share, least_updated_share);
  }
  if (contact_.failed > most_failed_updates) {
    body().correct_contact();
  } else {
    body().fix_contact(Fixing::none);
  }
  mixed_.evaluate();
  if (stage_ != Stage::acceleration) return;
  body().fix_contact(Fixing::all);
  mixed_.linearize_contact();
  mixed_.set_drags();
  contact_.norm = mixed_.norm();
  contact_.steps = 0;
  if (++contact_.updates > (effort_ == Effort::brief ? most_brief_updates : most_updates)) return;
  progress_ = {contact_.norm};
  acceleration_.clear();
}

/// Moves to where the steps so far predict the smallest residual, and on by a multigrid cycle; shorter while
/// the norm is much larger than the last ones.
template <class Real>
bool Equilibrium<Real>::linearized_step() {
  const double norm = mixed_.norm();
  norms_.push_back(norm);
  if (!std::isfinite(norm) || norm > 1e3 * norms_.front()) return false;
  const bool far = norms_.size() % steps_between_updates == 0 && norm > close_enough * norms_.front();
  if (far && is_healthy(body())) mixed_.linearize();
  mixed_.linearize_contact();
  reduced_ = mixed_.residuals();
  step_ = reduced_;
  acceleration_.combine(reduced_, step_);
  correction_ = reduced_;
  mixed_.correct(reduced_, correction_);
  add(1.0f, correction_, step_, blocks());
  const std::size_t recent = std::min<std::size_t>(norms_.size(), 3);
  const bool last_try = depends_on_path_ || effort_ == Effort::full;
  const double growth = last_try ? most_growth_of_the_last_try : most_growth;
  const double allowed = growth * *std::max_element(norms_.end() - static_cast<long>(recent), norms_.end());
  constexpr int most_trials = 7;
  double share = 1.0, done = 0.0;
  std::optional<Point> from;  // nodes that slide along obstacles do not return by themselves
  if (may_touch()) from = {body().state(), pressures()};
  for (int trial = 0; trial < most_trials; ++trial, share *= 0.5) {
    if (from) {
      go_to(*from);
      done = 0.0;
    }
    mixed_.move(step_, share - done);
    done = share;
    mixed_.evaluate();
    const double next = mixed_.norm();
    if (std::isfinite(next) && next <= allowed) {
      if (share < 1.0) multiply(static_cast<float>(share), step_, blocks());
      for (std::size_t row = 0; from && row < from->state.u.size(); ++row) {
        for (std::size_t i = 0; i < 3; ++i)
          step_.u[row][i] = static_cast<float>(body().state().u[row][i] - from->state.u[row][i]);
      }
      acceleration_.moved(step_);
      return true;
    }
  }
  return false;
}

template <class Real>
void Equilibrium<Real>::begin_multipliers() {
  stage_ = Stage::multipliers;
  body().fix_contact(Fixing::none);
  go_to(best_);
  mixed_.evaluate();
  progress_ = {mixed_.norm()};
  enough_ = (leaves_saddle_ ? multiplied_share_from_saddle : multiplied_share) * progress_.fallen;
}

/// One Newton step with the pressures as multipliers, which are updated afterwards.
template <class Real>
bool Equilibrium<Real>::multiplied() {
  if (mixed_.norm() < enough_ && convex_) {
    begin_acceleration();
    return accelerated();
  }
  if (progress_.take(mixed_.norm(), multiplied_patience)) {
    const auto multipliers = mixed_.multipliers(penalty_over_shear);
    if (is_healthy(body())) mixed_.linearize(multipliers.penalty);
    if (newton_step(mixed_, &multipliers, most_products_with_multipliers,
                    leaves_saddle_ ? &convex_ : nullptr)) {
      mixed_.take_pressures(multipliers);
      begin();
      mixed_.compare();
      return true;
    }
  }
  go_to_lower();
  begin_descent();
  return true;
}

template <class Real>
void Equilibrium<Real>::begin_descent() {
  stage_ = Stage::descent;
  progress_ = {residual()};
}

/// One Newton step of the body's own forces.
template <class Real>
bool Equilibrium<Real>::descended() {
  if (is_healthy(body())) mixed_.linearize();
  return progress_.take(residual(), descent_patience) && newton_step<Real>(mixed_, nullptr, most_products);
}

template <class Real>
SoftestMotions Equilibrium<Real>::softest_motions(const NodalField& points) {
  acceleration_.clear();
  mixed_.linearize();
  if (stage_ == Stage::descent) mixed_.take_own_pressures();
  return sandglass::softest_motions(mixed_, points);
}

template <class Real>
bool Equilibrium<Real>::leave(const std::vector<MixedVector>& falling, bool slowly) {
  effort_ = Effort::full;
  returns_ = 0;
  body().fix_contact(Fixing::none);
  leaves_saddle_ = true;
  convex_ = false;
  using Multipliers = typename MixedBody<Real>::Multipliers;
  const auto held = mixed_.pressure_varies() ? std::optional<Multipliers>()
                                             : std::optional(mixed_.multipliers(penalty_over_shear));
  const Multipliers* multipliers = held ? &*held : nullptr;
  const Point saddle{body().state(), pressures()};
  Rows<Real> f;
  const auto potential_along = [&](const MixedVector& motion, double length) {
    go_to(saddle);
    mixed_.move(motion, length);
    mixed_.evaluate(multipliers, f);
    return is_healthy(body()) ? mixed_.potential(multipliers) : INFINITY;
  };
  const double at_saddle = potential_along(falling.front(), 0.0);
  double least = at_saddle;
  const int directions = falling.size() > 1 ? 8 : 2;
  for (int k = 0; k < directions; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / directions;
    MixedVector motion = falling.front();
    multiply(static_cast<float>(std::cos(angle)), motion, blocks());
    if (falling.size() > 1) add(static_cast<float>(std::sin(angle)), falling[1], motion, blocks());
    double length = shortest_leap / mixed_.multigrid().elements().largest_gradient(motion.u);
    for (double before = at_saddle, now = 0.0;; before = now, length *= 2.0) {
      now = potential_along(motion, length);
      if (!(now < before)) break;
      if (now < least - hardly_lower * (at_saddle - least)) {
        least = now;
        best_ = {body().state(), pressures()};
      }
    }
  }
  if (!(least < at_saddle)) {
    go_to(saddle);
    mixed_.evaluate();
    return false;
  }
  go_to(best_);
  mixed_.evaluate(multipliers, f);
  if (multipliers != nullptr) mixed_.take_pressures(*multipliers);
  start_ = best_ = {body().state(), pressures()};
  begin();
  mixed_.evaluate();
  if (multipliers != nullptr && !slowly) {
    begin_multipliers();
  } else {
    begin_descent();
  }
  return true;
}

template <class Real>
void Equilibrium<Real>::go_to(const Point& point) {
  body().state() = point.state;
  pressures() = point.pressures;
}

/// Goes to the point of lower potential: the start of the search, or the best since.
template <class Real>
void Equilibrium<Real>::go_to_lower() {
  body().fix_contact(Fixing::none);
  go_to(potential_at(best_) < potential_at(start_) ? best_ : start_);
  mixed_.evaluate();
}

/// Infinite if an element is inverted.
template <class Real>
double Equilibrium<Real>::potential_at(const Point& point) {
  go_to(point);
  return is_healthy(body()) ? mixed_.potential(nullptr) : INFINITY;
}

template <class Real>
double Equilibrium<Real>::extend(double load, double most) {
  body().fix_contact(Fixing::friction);
  const Rows<Real> before = body().state().u;
  const double load_before = body().load_factor();
  begin();
  const Rows<Real> change = body().change_of_loads(load);
  body().impose(load);
  if (may_touch()) {  // obstacles of this load, as the undisplaced body would touch them
    const Rows<Real> imposed = body().state().u;
    body().state().u = before;
    mixed_.linearize();
    body().state().u = imposed;
  }
  MixedVector x = mixed_.multigrid().elements().zero(), loads = x;
  for (std::size_t row = 0; row < before.size(); ++row) {
    for (std::size_t i = 0; i < 3; ++i)
      x.u[row][i] = static_cast<float>(body().state().u[row][i] - before[row][i]);
  }
  loads.u = rounded_rows<float>(change);
  solve_linearized(mixed_, loads, x);
  const double gradient = mixed_.multigrid().elements().largest_gradient(x.u);
  const double share =
      std::min(mixed_.is_linear() ? 1.0 : std::min(1.0, most / gradient), body().share_in_reach(x.u));
  const double reached = share < 1.0 ? load_before + share * (load - load_before) : load;
  body().impose(reached);  // where obstacles are, along which it slides
  body().move_to(before);
  mixed_.move(x, share);
  body().impose(reached);
  body().fix_contact(Fixing::none);
  return reached;
}

template class Equilibrium<double>;
template class Equilibrium<float>;

}  // namespace sandglass
