#include "solve/body.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "math/row_loops.hpp"

namespace sandglass {

namespace {

/// Throws InputError if a case has features that are not yet divided among ranks.
void require_divisible(const Model& model) {
  if (model.choice().ranks->count() == 1) return;
  const auto& dynamics = model.scene().settings.dynamics;
  const auto contacts = contacts_of(model.scene().forces);
  const std::string what = !model.scene().ties.empty()    ? "ties and hanging nodes are"
                           : dynamics.subcycles > 1       ? "dynamics.subcycles > 1 is"
                           : dynamics.body_frequency != 0 ? "dynamics.body_frequency = 1 is"
                           : !contacts.empty() ? fmt::format("[[{}]] is", contacts.front()->traits().name)
                                               : "";
  if (what.empty()) return;
  throw InputError(fmt::format("{}: {} not divided among ranks; allowed: one rank with more threads",
                               model.scene().settings.file.string(), what));
}

}  // namespace

template <class Real>
Body<Real>::Body(const Model& model, const InternalForce<Real>& elements)
    : elements_(elements),
      scene_(model.scene()),
      constraints_(model.scene(), elements.layout()),
      ties_(model.scene().ties, elements.layout()),
      loads_(model.scene(), elements.layout()),
      state_(elements.undeformed()),
      force_(state_.u.size()),
      reactions_(scene_.constraints.size(), 0.0) {
  require_divisible(model);
}

template <class Real>
void Body<Real>::gather() {
  elements_.gather(state_);
  if (layout().team.ranks->count() == 1) return;
  layout().gather_rows(force_.data());
  reactions_ = constraints_.of_all(reactions_);
  loads_.gather();
}

template <class Real>
Reactions Body<Real>::reactions_of_sets() const {
  Reactions all = constraints_.sums_over_sets(reactions_);
  loads_.for_each_touch([&](const Touch& touch) { all[std::string(touch.name)] = touch.force; });
  return all;
}

template <class Real>
Reactions Body<Real>::moments_of_obstacles() const {
  Reactions all;
  loads_.for_each_touch([&](const Touch& touch) {
    if (touch.moment) all[std::string(touch.name)] = *touch.moment;
  });
  return all;
}

template <class Real>
Touch Body<Real>::touch() const {
  Touch sum{.dissipated = loads_.lost_by_pushes()};
  loads_.for_each_touch([&](const Touch& touch) {
    sum.depth = std::max(sum.depth, touch.depth);
    sum.stored += touch.stored;
    sum.dissipated += touch.dissipated;
    sum.contrary += touch.contrary;
    if (touch.passed < 0) return;
    sum.name = touch.name;
    sum.passed = touch.passed;
  });
  return sum;
}

template <class Real>
void Body<Real>::evaluate_forces() {
  elements_.evaluate(state_, force_);
  loads_.subtract(state_, force_);
  if (subcycling_) subcycling_->average(state_.u, force_);
  ties_.hand_on(force_);
  constraints_.take_reactions(force_, state_.increment, reactions_);
}

template <class Real>
void Body<Real>::evaluate_forces(State<Real>& state, Rows<Real>& force) const {
  elements_.evaluate(state, force);
  Loads<Real> loads = loads_;
  loads.subtract(state, force);
  ties_.hand_on(force);
  constraints_.clear(force);
}

template <class Real>
double Body<Real>::carried() const {
  const std::vector<double> all = constraints_.of_all(reactions_);
  double carried_square = 0.0;
#pragma omp simd reduction(+ : carried_square)
  for (std::size_t k = 0; k < all.size(); ++k) carried_square += all[k] * all[k];
  return std::sqrt(carried_square + loads_.square());
}

template <class Real>
double Body<Real>::residual() const {
  const double unbalanced = std::sqrt(dot(force_, force_, layout().row_blocks)),
               sum = std::max(carried(), 1e-3 * most_carried_);
  return sum > 0.0 ? unbalanced / sum : unbalanced;
}

template <class Real>
void Body<Real>::impose(double factor, double time) {
  load_factor_ = factor;
  loads_.set(time, factor);
  constraints_.impose(state_, factor);
  follow();
}

template <class Real>
void Body<Real>::impose(std::span<const double> displacements, double factor, double time) {
  load_factor_ = factor;
  loads_.set(time, factor);
  loads_.move_obstacles(displacements.last(loads_.moves()));
  constraints_.impose(state_, displacements);
  follow();
}

template <class Real>
Rows<Real> Body<Real>::change_of_loads(double factor) const {
  Rows<Real> rows = loads_.change_to(factor, factor, of_all(state_.u));
  ties_.hand_on(rows);
  constraints_.clear(rows);
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
  for (const Constraint& constraint : scene_.constraints) {
    const int row = layout.row_of_node[at(constraint.node)];
    rows[at(row)][at(constraint.component)] = Real(0);
  }
  return rows;
}

template <class Real>
ResidentBody<Real> Body<Real>::leave() const {
  const std::size_t rows = force_.size(), constraints = reactions_.size();
  const std::vector<Real> none(constraints);
  return {state_.u, state_.increment, force_, loads_.by_row(rows), none, none, none, std::vector<Real>(rows)};
}

template <class Real>
void Body<Real>::arrive(const ResidentBody<Real>& there, double step, double factor, double time) {
  state_.u = there.u;
  state_.increment = there.increment;
  state_.step = step;
  force_ = there.force;
  reactions_.assign(there.reactions.begin(), there.reactions.end());
  load_factor_ = factor;
  loads_.set(time, factor);
  loads_.follow(there.u, there.loads, there.works_of_loads);
}

template class Body<double>;
template class Body<float>;

}  // namespace sandglass
