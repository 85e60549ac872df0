#include "solve/explicit_step.hpp"

#include "math/row_loops.hpp"

namespace sandglass {

namespace {

std::vector<double> inverses(std::vector<double> values) {
  for (double& value : values) value = 1.0 / value;
  return values;
}

}  // namespace

template <class Real>
ExplicitStep<Real>::ExplicitStep(const Model& model, const InternalForce<Real>& elements)
    : body_(model, elements), inverse_masses_(body_.on_free_components(inverses(model.masses()))) {}

template <class Real>
void ExplicitStep<Real>::move(double step, double keep, double gain) {
  body_.state().step = step;
  const auto kept = static_cast<Real>(keep), gained = static_cast<Real>(-gain);
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

template class ExplicitStep<double>;
template class ExplicitStep<float>;

}  // namespace sandglass
