#include "solve/body.hpp"

#include <algorithm>
#include <cmath>

#include "math/row_loops.hpp"
#include "solve/health.hpp"

namespace sandglass {

namespace {

template <class Real>
std::array<Real, 3> rounded(const std::array<double, 3>& values) {
  return {static_cast<Real>(values[0]), static_cast<Real>(values[1]), static_cast<Real>(values[2])};
}

}  // namespace

template <class Real>
Body<Real>::Body(const Model& model, const InternalForce<Real>& elements)
    : elements_(elements),
      threads_(model.choice().threads),
      angles_(model.scene().angles),
      terms_(angles_.size()),
      ties_(model.scene().ties, elements.layout()),
      loads_(model.scene(), elements.layout()),
      largest_frequency_(model.scene().mesh.cells.size()),
      state_(elements.undeformed()),
      force_(state_.u.size()),
      reactions_(model.scene().constraints.size(), 0.0),
      per_element_(model.scene().mesh.cells.size()) {
  for (const auto& [node, component, path] : model.scene().constraints) {
    const int row = elements.layout().row_of_node[static_cast<std::size_t>(node)];
    constraints_.push_back({static_cast<std::size_t>(row), static_cast<std::size_t>(component),
                            rounded<Real>(path.share), path.angle});
  }
}

template <class Real>
void Body<Real>::evaluate_forces() {
  elements_.evaluate(state_, force_);
  loads_.subtract(state_, force_);
  if (subcycling_) subcycling_->average(state_.u, force_);
  ties_.hand_on(force_);
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    Real& component = force_[constraints_[k].row][constraints_[k].component];
    reactions_[k] = static_cast<double>(component);
    component = Real(0);
    state_.increment[constraints_[k].row][constraints_[k].component] = Real(0);
  }
}

template <class Real>
double Body<Real>::residual() const {
  return residual(dot(force_, force_, threads_));
}

template <class Real>
double Body<Real>::residual(double free_square) const {
  const double unbalanced = std::sqrt(free_square);
  double carried_square = 0.0;
#pragma omp simd reduction(+ : carried_square)
  for (std::size_t k = 0; k < reactions_.size(); ++k) carried_square += reactions_[k] * reactions_[k];
  const double carried = std::sqrt(carried_square + loads_.square());
  return carried > 0.0 ? unbalanced / carried : unbalanced;
}

template <class Real>
void Body<Real>::impose(double factor, double time) {
  load_factor_ = factor;
  loads_.set(time, factor);
  for (std::size_t m = 0; m < terms_.size(); ++m) terms_[m] = rounded<Real>(path_terms(angles_[m], factor));
  for (const auto& constraint : constraints_) {
    const std::array<Real, 3>&share = constraint.share, &terms = terms_[constraint.angle];
    impose(constraint, share[0] * terms[0] + share[1] * terms[1] + share[2] * terms[2]);
  }
  follow();
}

template <class Real>
void Body<Real>::impose(std::span<const double> displacements, double factor, double time) {
  load_factor_ = factor;
  loads_.set(time, factor);
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    impose(constraints_[k], static_cast<Real>(displacements[k]));
  }
  follow();
}

template <class Real>
Rows<Real> Body<Real>::change_of_loads(double factor) const {
  Rows<Real> rows = loads_.change_to(factor, factor, state_.u);
  ties_.hand_on(rows);
  for (const auto& constraint : constraints_) rows[constraint.row][constraint.component] = Real(0);
  return rows;
}

template <class Real>
void Body<Real>::move_to(const Rows<Real>& target) {
  Real *u = numbers_of(state_.u), *increment = numbers_of(state_.increment);
  const Real* to = numbers_of(target);
  for_each_block(4 * target.size(), threads_, [=](std::size_t first, std::size_t last) {
#pragma omp simd
    for (std::size_t k = first; k < last; ++k) {
      increment[k] = to[k] - u[k];
      u[k] = to[k];
    }
  });
}

template <class Real>
Rows<Real> Body<Real>::on_free_components(const std::vector<double>& nodal) const {
  const Layout& layout = elements_.layout();
  Rows<Real> rows(layout.rows());
  for (std::size_t r = 0; r < layout.nodes; ++r) {
    const auto value = static_cast<Real>(nodal[static_cast<std::size_t>(layout.node_of_row[r])]);
    for (std::size_t i = 0; i < 3; ++i) rows[r][i] = value;
  }
  ties_.clear(rows);
  for (const auto& constraint : constraints_) rows[constraint.row][constraint.component] = Real(0);
  return rows;
}

template <class Real>
Frame Body<Real>::frame(double time, NodalField v) const {
  Frame frame{time,
              field(state_.u),
              std::move(v),
              std::vector<double>(per_element_.size()),
              std::vector<double>(per_element_.size()),
              elements_.levels(state_)};
  elements_.jacobians(state_, frame.jacobians);
  elements_.hourglass_energy_densities(state_, frame.hourglass_energy_densities);
  return frame;
}

template <class Real>
void Body<Real>::require_healthy(long step) {
  elements_.smallest_jacobians(state_, per_element_);
  sandglass::require_healthy(per_element_, step);
}

template <class Real>
bool Body<Real>::healthy() {
  elements_.smallest_jacobians(state_, per_element_);
  return std::all_of(per_element_.begin(), per_element_.end(), is_healthy);
}

template <class Real>
const std::vector<double>& Body<Real>::stiffness_bounds() {
  elements_.stiffness_bounds(state_, per_element_);
  return per_element_;
}

template <class Real>
StableStep Body<Real>::stable_step(const Model& model, const Rows<Real>& inverse_masses, double given_step) {
  const std::vector<double>& bounds = stiffness_bounds();
  if (subcycling_) return subcycling_->choose_substeps(stable_steps(model, bounds), given_step);
  StableStep stable = sandglass::stable_step(model, bounds);
  if (model.scene().description.dynamics.body_frequency == 0) return stable;
  const double square = largest_frequency_.square(model.scene().mesh, elements_, ties_, inverse_masses,
                                                  state_, bounds, std::pow(2.0 / stable.step, 2));
  if (std::isfinite(square)) stable.step = std::max(stable.step, stable_step_of(model, square));
  return stable;
}

Frame static_frame(const Model& model, double time, const NodalField& u) {
  return std::visit(
      [&]<class Real>(const std::unique_ptr<InternalForce<Real>>& elements) {
        Body<Real> body(model, *elements);
        body.state() = state_at(*elements, u);
        body.evaluate_forces();
        return body.frame(time, NodalField(u.size()));
      },
      model.internal_force());
}

template class Body<double>;
template class Body<float>;

}  // namespace sandglass
