#include "solve/leapfrog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "math/row_loops.hpp"

namespace sandglass {

namespace {

std::vector<double> inverses(std::vector<double> values) {
  for (double& value : values) value = 1.0 / value;
  return values;
}

/// The smallest of the steps of all ranks; of equal ones that of the first element.
StableStep smallest_of(const Ranks& ranks, const StableStep& own) {
  const auto steps = ranks.of_all(own.step), elements = ranks.of_all(static_cast<double>(own.element));
  StableStep smallest = own;
  for (std::size_t r = 0; r < steps.size(); ++r) {
    const auto element = static_cast<int>(elements[r]);
    if (steps[r] < smallest.step || (steps[r] == smallest.step && element < smallest.element)) {
      smallest = {steps[r], element};
    }
  }
  return smallest;
}

}  // namespace

void require_steps(const Model& model) {
  if (!method_named(model.choice().method).is_condensed) return;
  throw InputError(fmt::format(
      "{}: method '{}' has no dynamics: it superposes static answers; use it on quasi-static cases, or "
      "method '{}'",
      model.scene().settings.file.string(), model.choice().method, "linear"));
}

template <class Real>
Leapfrog<Real>::Leapfrog(const Model& model, const InternalForce<Real>& elements, double damping)
    : body_(model, elements),
      largest_frequency_(model.scene().mesh.cells.size()),
      inverse_masses_(body_.on_free_components(inverses(model.masses()))),
      clock_{.damping = damping} {}

template <class Real>
StableStep Leapfrog<Real>::stable_step(const Model& model, double given_step) {
  std::vector<double> bounds(model.element_masses().size(), 0.0);
  body_.elements().stiffness_bounds(body_.state(), bounds);
  if (auto* subcycling = body_.subcycling()) {
    return subcycling->choose_substeps(stable_steps(model, std::move(bounds)), given_step);
  }
  StableStep stable = smallest_of(*body_.layout().team.ranks, sandglass::stable_step(model, bounds));
  if (model.scene().settings.dynamics.body_frequency != 0) {
    const double square =
        largest_frequency_.square(model.scene().mesh, body_.elements(), body_.ties(), inverse_masses_,
                                  body_.state(), bounds, std::pow(2.0 / stable.step, 2));
    if (std::isfinite(square)) stable.step = std::max(stable.step, stable_step_of(model, square));
  }
  return damped(stable, clock_.damping);
}

template <class Real>
void Leapfrog<Real>::move(double step, LeapfrogClock::Coefficients coefficients) {
  body_.state().step = step;
  const auto kept = static_cast<Real>(coefficients.keep), gained = static_cast<Real>(-coefficients.gain);
  Real* u = numbers_of(body_.state().u);
  Real* increment = numbers_of(body_.state().increment);
  const Real* force = numbers_of(body_.free_forces());
  const Real* inverse_mass = numbers_of(inverse_masses_);
  body_.layout().row_blocks.for_each([=](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t k = first; k < last; ++k) {
      increment[k] = kept * increment[k] + gained * inverse_mass[k] * force[k];
      u[k] += increment[k];
    }
  });
}

template <class Real>
void Leapfrog<Real>::set_initial_velocities(const NodalField& v) {
  if (v.empty()) return;
  Rows<Real>& increment = body_.state().increment;
  increment = to_rows<Real>(v, body_.layout());
  for (std::size_t r = 0; r < increment.size(); ++r) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(inverse_masses_[r][i] > Real(0))) increment[r][i] = Real(0);
    }
  }
}

template <class Real>
NodalField Leapfrog<Real>::free_velocities(bool with_pushes) const {
  const double half = 0.5 * clock_.step_size;
  const Rows<Real>& increment = body_.state().increment;
  Rows<Real> pushed;
  if (with_pushes) {
    pushed = body_.free_forces();
    body_.subtract_pushes(pushed);
  }
  const Rows<Real>& force = with_pushes ? pushed : body_.free_forces();
  Rows<Real> rows(increment.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double v_half = static_cast<double>(increment[r][i]) / clock_.increment_time;
      const double acceleration = -static_cast<double>(inverse_masses_[r][i] * force[r][i]);
      rows[r][i] = static_cast<Real>((v_half + half * acceleration) / (1.0 + half * clock_.damping));
    }
  }
  return body_.field(rows);
}

template <class Real>
double Leapfrog<Real>::energy_of_step() const {
  const double dt = clock_.step_size, c = clock_.damping, share = dt / (1.0 + 0.5 * c * dt);
  Rows<Real> change(inverse_masses_.size()), momentum(change.size());  // of velocities, over the step
  const auto factor = static_cast<Real>(share), by_rate = static_cast<Real>(c / clock_.increment_time);
  const Real *force = numbers_of(body_.free_forces()), *increment = numbers_of(body_.state().increment),
             *inverse_mass = numbers_of(inverse_masses_);
  Real *dv = numbers_of(change), *dp = numbers_of(momentum);
  body_.layout().row_blocks.for_each([=](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t k = first; k < last; ++k) {
      const Real w = inverse_mass[k], damped = by_rate * increment[k];
      dv[k] = factor * (w * force[k] + damped);
      dp[k] = factor * (force[k] + (w > Real(0) ? damped / w : Real(0)));
    }
  });
  return 0.125 * dot(momentum, change, body_.layout().row_blocks);
}

template class Leapfrog<double>;
template class Leapfrog<float>;

}  // namespace sandglass
