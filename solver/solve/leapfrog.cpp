#include "solve/leapfrog.hpp"

#include <fmt/format.h>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "math/row_loops.hpp"

namespace sandglass {

namespace {

std::vector<double> inverses(std::vector<double> values) {
  for (double& value : values) value = 1.0 / value;
  return values;
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
      inverse_masses_(body_.on_free_components(inverses(model.masses()))),
      clock_{.damping = damping} {}

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
NodalField Leapfrog<Real>::free_velocities() const {
  const double half = 0.5 * clock_.step_size;
  const Rows<Real>& increment = body_.state().increment;
  const Rows<Real>& force = body_.free_forces();
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
  const Rows<Real>& force = body_.free_forces();
  Rows<Real> acceleration(force.size());
  for (std::size_t r = 0; r < force.size(); ++r) {
    for (std::size_t i = 0; i < 3; ++i) acceleration[r][i] = inverse_masses_[r][i] * force[r][i];
  }
  return 0.125 * clock_.step_size * clock_.step_size * dot(force, acceleration, body_.layout().row_blocks);
}

template class Leapfrog<double>;
template class Leapfrog<float>;

}  // namespace sandglass
