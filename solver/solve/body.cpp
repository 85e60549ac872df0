#include "solve/body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/face_gather.hpp"
#include "base/error.hpp"
#include "math/row_loops.hpp"
#include "solve/health.hpp"

namespace sandglass {

namespace {

template <class Real>
std::array<Real, 3> rounded(const std::array<double, 3>& values) {
  return {static_cast<Real>(values[0]), static_cast<Real>(values[1]), static_cast<Real>(values[2])};
}

/// Throws InputError for what is not yet divided among ranks.
void require_divisible(const Model& model) {
  if (model.choice().ranks->count() == 1) return;
  const auto& dynamics = model.scene().settings.dynamics;
  const char* what = !model.scene().ties.empty()    ? "ties and hanging nodes are"
                     : dynamics.subcycles > 1       ? "dynamics.subcycles > 1 is"
                     : dynamics.body_frequency != 0 ? "dynamics.body_frequency = 1 is"
                                                    : nullptr;
  if (what == nullptr) return;
  throw InputError(fmt::format("{}: {} not divided among ranks; allowed: one rank with more threads",
                               model.scene().settings.file.string(), what));
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

template <class Real>
Body<Real>::Body(const Model& model, const InternalForce<Real>& elements)
    : elements_(elements),
      scene_(model.scene()),
      terms_(scene_.angles.size()),
      ties_(model.scene().ties, elements.layout()),
      loads_(model.scene(), elements.layout()),
      largest_frequency_(model.scene().mesh.cells.size()),
      state_(elements.undeformed()),
      force_(state_.u.size()),
      reactions_(scene_.constraints.size(), 0.0),
      per_element_(model.scene().mesh.cells.size()) {
  require_divisible(model);
  const Blocks::Range local = layout().row_blocks.local();
  for (std::size_t k = 0; k < reactions_.size(); ++k) {
    const auto& [node, component, path, group] = scene_.constraints[k];
    const auto row = at(layout().row_of_node[at(node)]);
    if (layout().owns(node)) own_constraints_.push_back(k);
    if (4 * row < local.first || 4 * row >= local.last) continue;
    constraints_.push_back({k, row, at(component), rounded<Real>(path.share), path.angle});
  }
}

template <class Real>
std::vector<double> Body<Real>::of_all_constraints(const std::vector<double>& numbers) const {
  std::vector<double> of_all(numbers.size());
  for (const std::size_t k : own_constraints_) of_all[k] = numbers[k];
  ranks().sum(of_all);
  return of_all;
}

template <class Real>
Reactions Body<Real>::set_reactions() const {
  Reactions sums;
  const std::vector<double> all = of_all_constraints(reactions_);
  for (const auto& [set, constraints] : scene_.driven) {
    Vector& sum = sums[set];
    for (const std::size_t k : constraints) sum[at(scene_.constraints[k].component)] += all[k];
  }
  return sums;
}

template <class Real>
void Body<Real>::gather() {
  if (ranks().count() == 1) return;
  elements_.gather(state_);
  layout().gather_rows(force_.data());
  reactions_ = of_all_constraints(reactions_);
  loads_.gather();
}

template <class Real>
void Body<Real>::evaluate_forces() {
  elements_.evaluate(state_, force_);
  loads_.subtract(state_, force_);
  if (subcycling_) subcycling_->average(state_.u, force_);
  ties_.hand_on(force_);
  for (const RowConstraint& constraint : constraints_) {
    Real& component = force_[constraint.row][constraint.component];
    reactions_[constraint.index] = static_cast<double>(component);
    component = Real(0);
    state_.increment[constraint.row][constraint.component] = Real(0);
  }
}

template <class Real>
void Body<Real>::evaluate_forces(State<Real>& state, Rows<Real>& force) const {
  elements_.evaluate(state, force);
  Loads<Real> loads = loads_;
  loads.subtract(state, force);
  ties_.hand_on(force);
  for (const RowConstraint& constraint : constraints_) force[constraint.row][constraint.component] = Real(0);
}

template <class Real>
double Body<Real>::carried() const {
  const std::vector<double> all = of_all_constraints(reactions_);
  double carried_square = 0.0;
#pragma omp simd reduction(+ : carried_square)
  for (std::size_t k = 0; k < all.size(); ++k) carried_square += all[k] * all[k];
  return std::sqrt(carried_square + loads_.square());
}

template <class Real>
double Body<Real>::residual() const {
  const double unbalanced = std::sqrt(dot(force_, force_, layout().row_blocks)), sum = carried();
  return sum > 0.0 ? unbalanced / sum : unbalanced;
}

template <class Real>
void Body<Real>::impose(double factor, double time) {
  load_factor_ = factor;
  loads_.set(time, factor);
  for (std::size_t m = 0; m < terms_.size(); ++m)
    terms_[m] = rounded<Real>(path_terms(scene_.angles[m], factor));
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
  for (const RowConstraint& constraint : constraints_) {
    impose(constraint, static_cast<Real>(displacements[constraint.index]));
  }
  follow();
}

template <class Real>
Rows<Real> Body<Real>::change_of_loads(double factor) const {
  Rows<Real> rows = loads_.change_to(factor, factor, of_all(state_.u));
  ties_.hand_on(rows);
  for (const auto& constraint : constraints_) rows[constraint.row][constraint.component] = Real(0);
  return rows;
}

template <class Real>
void Body<Real>::move_to(const Rows<Real>& target) {
  Real *u = numbers_of(state_.u), *increment = numbers_of(state_.increment);
  const Real* to = numbers_of(target);
  layout().row_blocks.for_each([=](std::size_t first, std::size_t last) {
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
    const auto value = static_cast<Real>(nodal[at(layout.node_of_row[r])]);
    for (std::size_t i = 0; i < 3; ++i) rows[r][i] = value;
  }
  ties_.clear(rows);
  for (const auto& [node, component, path, group] : scene_.constraints) {
    const int row = layout.row_of_node[at(node)];
    rows[at(row)][at(component)] = Real(0);
  }
  return rows;
}

template <class Real>
Frame Body<Real>::frame(double time, NodalField v) const {
  Frame frame{time,
              field(state_.u),
              std::move(v),
              std::vector<double>(per_element_.size()),
              std::vector<double>(per_element_.size()),
              elements_.levels(state_),
              std::vector<double>(9 * per_element_.size()),
              set_reactions()};
  elements_.jacobians(state_, frame.jacobians);
  elements_.hourglass_energy_densities(state_, frame.hourglass_energy_densities);
  elements_.stresses(state_, centred_coordinates<Real>(scene_.mesh.points, layout()), frame.stresses);
  for (auto* values : {&frame.jacobians, &frame.hourglass_energy_densities, &frame.levels, &frame.stresses}) {
    if (!values->empty()) gather_elements(*values);
  }
  return frame;
}

template <class Real>
void Body<Real>::require_healthy(long step) {
  if (healthy()) return;
  gather_elements(per_element_);
  sandglass::require_healthy(per_element_, step);
}

template <class Real>
bool Body<Real>::healthy() {
  fill_others(1.0);
  elements_.smallest_jacobians(state_, per_element_);
  return !ranks().any(!std::all_of(per_element_.begin(), per_element_.end(), is_healthy));
}

template <class Real>
StableStep Body<Real>::stable_step(const Model& model, const Rows<Real>& inverse_masses, double given_step) {
  const std::vector<double>& bounds = per_element_;
  fill_others(0.0);
  elements_.stiffness_bounds(state_, per_element_);
  if (subcycling_) return subcycling_->choose_substeps(stable_steps(model, bounds), given_step);
  StableStep stable = smallest_of(ranks(), sandglass::stable_step(model, bounds));
  if (model.scene().settings.dynamics.body_frequency == 0) return stable;
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
