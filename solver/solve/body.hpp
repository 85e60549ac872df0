#pragma once

#include <algorithm>
#include <span>

#include "assembly/row_ties.hpp"
#include "problem/model.hpp"
#include "problem/observer.hpp"
#include "solve/largest_frequency.hpp"
#include "solve/loads.hpp"
#include "solve/subcycling.hpp"

namespace sandglass {

/// A model in the form of the time loop: its state in rows, the forces on it, and its constraints with their
/// reactions.
template <class Real>
class Body {
 public:
  /// The undeformed body, without loads.
  Body(const Model& model, const InternalForce<Real>& elements);

  /// The present state; see State.
  const State<Real>& state() const { return state_; }
  State<Real>& state() { return state_; }

  /// Internal forces minus loads (N) of the last evaluation, tied nodes' handed on to those they follow; zero
  /// on constrained components and tied nodes.
  const Rows<Real>& free_forces() const { return force_; }

  /// Internal forces minus loads (N) on constrained components, in the order of the scene's constraints: the
  /// reactions of a body in equilibrium; of several ranks each knows those of its own nodes.
  const std::vector<double>& reactions() const { return reactions_; }

  /// The constraints of nodes whose rows this rank owns.
  const std::vector<std::size_t>& own_constraints() const { return own_constraints_; }

  /// Numbers in the order of the scene's constraints, of which each rank knows its own, of all ranks.
  std::vector<double> of_all_constraints(const std::vector<double>& numbers) const;

  /// The sum of the reactions (N) of each set that the case drives: the force that holds or moves it, without
  /// what accelerates the masses of its own nodes.
  Reactions set_reactions() const;

  /// Sets the values of elements that other ranks own, in the numbering of the mesh: as many for each.
  template <class T>
  void gather_elements(std::vector<T>& values) const {
    std::vector<double> all(values.size());
    const std::size_t count = values.size() / per_element_.size();
    const auto rank = static_cast<std::size_t>(ranks().rank());
    for (std::size_t c = layout().rank_cells[rank]; c < layout().rank_cells[rank + 1]; ++c) {
      if (layout().elements[c] < 0) continue;
      const std::size_t first = count * static_cast<std::size_t>(layout().elements[c]);
      for (std::size_t k = first; k < first + count; ++k) all[k] = static_cast<double>(values[k]);
    }
    ranks().sum(all);
    std::transform(all.begin(), all.end(), values.begin(),
                   [](double value) { return static_cast<T>(value); });
  }

  /// Evaluates the forces of the state. Afterwards the increments of constrained components are cleared, so
  /// that the update of increments can ignore constraints.
  void evaluate_forces();

  /// Sets `force` to the free forces of another state, and leaves those of the last evaluation.
  void evaluate_forces(State<Real>& state, Rows<Real>& force) const;

  /// The norm of reactions and loads together, N.
  double carried() const;

  /// |free forces| over the norm of reactions and loads together; |free forces| (N) if these are zero.
  double residual() const;

  /// Moves to displacements `target` (m); `impose` sets constrained components and tied nodes afterwards.
  void move_to(const Rows<Real>& target);

  /// Sets constrained components to their paths at a load factor, and their increments to the change; from
  /// now on loads are those of this factor and `time` (s).
  void impose(double factor, double time);

  /// The same in a quasi-static answer, whose time is the load factor.
  void impose(double factor) { impose(factor, factor); }

  /// Sets constrained components, in the order of the scene's constraints, to `displacements` (m) and their
  /// increments to the change; from now on loads are those of this factor and `time` (s).
  void impose(std::span<const double> displacements, double factor, double time);

  /// Lets tied nodes and their increments follow.
  void follow() {
    ties_.follow(state_.u);
    ties_.follow(state_.increment);
  }

  /// The ties of the scene, on rows.
  const RowTies<Real>& ties() const { return ties_; }

  /// The present factor of the load.
  double load_factor() const { return load_factor_; }

  /// The change of the loads (N) from now to another factor, by row; zero on constrained components.
  Rows<Real> change_of_loads(double factor) const;

  /// See Loads::potential, J.
  double load_potential() const { return loads_.potential(of_all(state_.u)); }

  /// Adds the work of the loads since the last call.
  void add_work_of_loads() { loads_.add_work(state_.u); }

  /// The work (J) of the loads, of all calls.
  double work_of_loads() const { return loads_.work(); }

  /// Nodal values as rows, zero on constrained components, at tied nodes and in spare rows: with inverse
  /// masses only free components move, without a branch.
  Rows<Real> on_free_components(const std::vector<double>& nodal) const;

  /// The order of its rows.
  const Layout& layout() const { return elements_.layout(); }

  /// Rows, of which each rank knows its own, in the numbering of the mesh.
  NodalField field(const Rows<Real>& rows) const { return to_field(of_all(rows), layout()); }

  /// Strain and hourglass energy, J.
  StrainEnergies energies() const { return elements_.energies(state_); }

  /// A frame of the present state at `time` (s) with velocities v (m/s).
  Frame frame(double time, NodalField v) const;

  /// Throws ComputationError when a displacement is not finite or an element is inverted.
  void require_healthy(long step);

  /// Whether all displacements are finite and no element is inverted.
  bool healthy();

  /// The stable step, by bounds of elements or, where the case says so, by the largest frequency of the body.
  /// `inverse_masses` as LargestFrequency has them, `given_step` (s) is the one that a user demands, or 0.
  StableStep stable_step(const Model& model, const Rows<Real>& inverse_masses, double given_step = 0.0);

  /// Lets small elements take small steps alone from the next evaluation on, if the case asks for it; see
  /// Subcycling.
  void subcycle(const Model& model, const Rows<Real>& inverse_masses) {
    if (model.scene().settings.dynamics.subcycles > 1) subcycling_.emplace(model, elements_, inverse_masses);
  }

  /// The number of small steps that small elements take in a step at present.
  int substeps() const { return subcycling_ ? subcycling_->substeps() : 1; }

  /// Sets the step (s) that follows evaluations from now on.
  void set_step(double step) {
    if (subcycling_) subcycling_->set_step(step);
  }

  /// See InternalForce::adapt.
  Adaptation adapt(const Rows<Real>& mobility, double length, double demoting_length) {
    return elements_.adapt(state_, mobility, length, demoting_length);
  }

  /// The data that the next step or load level depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    gather();
    archive("displacement", state_.u);
    archive("increment", state_.increment);
    archive("element history", state_.history);
    std::vector<double> levels = elements_.levels(state_);
    if (!levels.empty()) gather_elements(levels);
    archive("element level", levels);
    elements_.set_levels(state_, levels);
    archive("increment step", state_.step);
    archive("free force", force_);
    archive("body reaction", reactions_);
    archive("load factor", load_factor_);
    loads_.keep(archive);
    if (subcycling_) subcycling_->keep(archive);
    largest_frequency_.keep(archive);
  }

 private:
  struct RowConstraint {
    std::size_t index;  // in the scene
    std::size_t row;
    std::size_t component;
    std::array<Real, 3> share;  // of the terms of its path, m
    std::size_t angle;
  };

  void impose(const RowConstraint& constraint, Real displacement) {
    Real& u = state_.u[constraint.row][constraint.component];
    state_.increment[constraint.row][constraint.component] += displacement - u;
    u = displacement;
  }

  /// Rows, of which each rank knows its own, of all ranks.
  Rows<Real> of_all(Rows<Real> rows) const {
    layout().gather_rows(rows.data());
    return rows;
  }

  /// Makes everything that is kept known to all ranks.
  void gather();

  /// Sets the values of elements that other ranks own.
  void fill_others(double value) {
    if (ranks().count() > 1) std::fill(per_element_.begin(), per_element_.end(), value);
  }

  const Ranks& ranks() const { return *layout().team.ranks; }

  const InternalForce<Real>& elements_;
  const Scene& scene_;
  std::vector<std::array<Real, 3>> terms_;  // of paths of each angle, at the present factor
  std::vector<RowConstraint> constraints_;  // of rows that this rank computes
  std::vector<std::size_t> own_constraints_;
  RowTies<Real> ties_;
  Loads<Real> loads_;
  std::optional<Subcycling<Real>> subcycling_;
  LargestFrequency<Real> largest_frequency_;
  double load_factor_ = 0.0;
  State<Real> state_;
  Rows<Real> force_;
  std::vector<double> reactions_;
  std::vector<double> per_element_;
};

/// A frame of a model with displacements u (m), reached in one step, and zero velocities.
Frame static_frame(const Model& model, double time, const NodalField& u);

extern template class Body<double>;
extern template class Body<float>;

}  // namespace sandglass
