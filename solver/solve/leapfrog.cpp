#include "solve/leapfrog.hpp"

#include <fmt/format.h>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"

namespace sandglass {

void require_steps(const Model& model) {
  if (!method_named(model.choice().method).is_condensed) return;
  throw InputError(fmt::format(
      "{}: method '{}' has no dynamics: it superposes static answers; use it on quasi-static cases, or "
      "method '{}'",
      model.scene().description.file.string(), model.choice().method, "linear"));
}

template <class Real>
void Leapfrog<Real>::set_initial_velocities(const NodalField& v) {
  if (v.empty()) return;
  const Rows<Real>& inverse_masses = explicit_step_.inverse_masses();
  Rows<Real>& increment = body().state().increment;
  increment = to_rows<Real>(v, body().layout());
  for (std::size_t r = 0; r < increment.size(); ++r) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(inverse_masses[r][i] > Real(0))) increment[r][i] = Real(0);
    }
  }
}

template <class Real>
NodalField Leapfrog<Real>::free_velocities() const {
  const double half = 0.5 * clock_.step_size;
  const Rows<Real>& increment = body().state().increment;
  const Rows<Real>& force = body().free_forces();
  const Rows<Real>& inverse_masses = explicit_step_.inverse_masses();
  Rows<Real> rows(increment.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double v_half = static_cast<double>(increment[r][i]) / clock_.increment_time;
      const double acceleration = -static_cast<double>(inverse_masses[r][i] * force[r][i]);
      rows[r][i] = static_cast<Real>((v_half + half * acceleration) / (1.0 + half * clock_.damping));
    }
  }
  return body().field(rows);
}

template class Leapfrog<double>;
template class Leapfrog<float>;

}  // namespace sandglass
