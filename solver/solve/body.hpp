#pragma once

#include <optional>
#include <span>

#include "assembly/gather_elements.hpp"
#include "assembly/resident.hpp"
#include "assembly/row_ties.hpp"
#include "problem/model.hpp"
#include "solve/loads.hpp"
#include "solve/row_constraints.hpp"
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

  /// Internal forces minus loads (N) of the last evaluation, with the forces on tied nodes transferred to the
  /// nodes that they follow; zero on constrained components and tied nodes.
  const Rows<Real>& free_forces() const { return force_; }

  /// Internal forces minus loads (N) on constrained components, in the order of the scene's constraints: the
  /// reactions of a body in equilibrium. Each rank knows only the reactions of its own nodes.
  const std::vector<double>& reactions() const { return reactions_; }

  /// The constraints of the scene, on rows.
  const RowConstraints<Real>& constraints() const { return constraints_; }

  /// The sum of the reactions (N) of each set that the case drives: the force that holds or moves it, without
  /// the inertia of its own nodes. And the force of each obstacle on the body, by its name.
  Reactions reactions_of_sets() const;

  /// The moments (N m) of the forces of obstacles on the body; see Touch.
  Reactions moments_of_obstacles() const;

  /// Evaluates the forces of the state. Afterwards the increments of constrained components are cleared, so
  /// that the update of increments can ignore constraints.
  void evaluate_forces();

  /// Sets `force` to the free forces of another state; the forces of the last evaluation do not change.
  void evaluate_forces(State<Real>& state, Rows<Real>& force) const;

  /// The norm of reactions and loads together, N.
  double carried() const;

  /// |free forces| over the norm of reactions and loads together, or over a thousandth of the largest at the
  /// end of a load level, if that is more: a body that is unloaded bears nothing. |free forces| (N) if both
  /// are zero.
  double residual() const;

  /// Moves to displacements `target` (m); `impose` sets constrained components and tied nodes afterwards.
  void move_to(const Rows<Real>& target);

  /// Sets constrained components that move to their paths at a load factor, and their increments to the
  /// change; from now on loads follow this factor and `time` (s). In motions, held components stay where they
  /// are.
  void impose(double factor, double time);

  /// The same in a quasi-static answer, where time is the load factor, from any displacements.
  void impose(double factor) {
    constraints_.hold(state_);
    impose(factor, factor);
  }

  /// Sets constrained components, in the order of the scene's constraints, to `displacements` (m) and their
  /// increments to the change; from now on loads follow this factor and `time` (s). Three more displacements
  /// follow for each obstacle that a program may move.
  void impose(std::span<const double> displacements, double factor, double time);

  /// The factors of load curves at a time (s) and load factor.
  std::vector<double> factors_of_loads(double time, double factor) const {
    return loads_.factors_at(time, factor);
  }

  /// The state from which another processor continues the motion.
  ResidentBody<Real> leave() const;

  /// Takes over the state that it has reached, at a time (s) and load factor, after a step of `step` s.
  void arrive(const ResidentBody<Real>& there, double step, double factor, double time);

  /// Updates tied nodes and their increments.
  void follow() {
    ties_.follow(state_.u);
    ties_.follow(state_.increment);
  }

  /// The ties of the scene, on rows.
  const RowTies<Real>& ties() const { return ties_; }

  /// The present load factor.
  double load_factor() const { return load_factor_; }

  /// The change of the loads (N) from now to another factor, by row; zero on constrained components.
  Rows<Real> change_of_loads(double factor) const;

  /// See Loads::potential, J.
  double load_potential() const { return loads_.potential(of_all(state_.u)); }

  /// How the body touched an obstacle at the last evaluation; none if there is no obstacle of this name.
  std::optional<Touch> touch(std::string_view obstacle) const {
    std::optional<Touch> found;
    loads_.for_each_touch([&](const Touch& touch) {
      if (touch.name == obstacle) found = touch;
    });
    return found;
  }

  /// The sums over all contacts of energies, and the largest depth, at the last evaluation; the name of one
  /// that a node passed.
  Touch touch() const;

  /// See Loads::slide.
  void slide(const Rows<Real>& before, Rows<Real>& u) const { loads_.slide(before, u); }

  /// See Loads::begin_again; with the reactions and moments at rest.
  void begin_again(const Reactions& reactions, const Reactions& moments) {
    loads_.begin_again(reactions, moments);
  }

  /// See Loads::fix_contact.
  void fix_contact(Fixing fixing) { loads_.fix_contact(fixing); }

  /// See Loads::augment_contact.
  bool augment_contact(Augmentation augmentation) { return loads_.augment_contact(augmentation); }

  /// See Loads::end_level.
  Touch end_level(bool may_shorten) {
    const Touch through = loads_.end_level(state_.u, may_shorten);
    if (through.passed < 0) most_carried_ = std::max(most_carried_, carried());
    return through;
  }

  /// See Loads::correct_contact.
  void correct_contact() { loads_.correct_contact(); }

  /// See Loads::share_in_reach.
  double share_in_reach(const Rows<float>& change) const { return loads_.share_in_reach(change); }

  /// See Loads::springs_of_contact.
  std::vector<Spring> springs_of_contact() const { return loads_.springs_of_contact(of_all(state_.u)); }

  /// See Loads::push_out.
  void push_out(const Rows<Real>& inverse_masses, double gain) {
    if (loads_.push_out(state_, inverse_masses, gain)) follow();
  }

  /// See Loads::subtract_pushes.
  void subtract_pushes(Rows<Real>& force) const { loads_.subtract_pushes(force); }

  /// Adds the work of the loads since the last call.
  void add_work_of_loads() { loads_.add_work(state_.u); }

  /// The work (J) of the loads in all calls.
  double work_of_loads() const { return loads_.work(); }

  /// Nodal values as rows, zero on constrained components, at tied nodes and in spare rows: with inverse
  /// masses only free components move, without a branch.
  Rows<Real> on_free_components(const std::vector<double>& nodal) const;

  const InternalForce<Real>& elements() const { return elements_; }
  const Scene& scene() const { return scene_; }

  /// The order of its rows.
  const Layout& layout() const { return elements_.layout(); }

  /// Rows in the numbering of the mesh, from ranks that each know their own.
  NodalField field(const Rows<Real>& rows) const { return to_field(of_all(rows), layout()); }

  /// Strain and hourglass energy, J.
  StrainEnergies energies() const { return elements_.energies(state_); }

  /// Starts subcycling with the next evaluation, if the case requests it; see Subcycling.
  void subcycle(const Model& model, const Rows<Real>& inverse_masses) {
    if (model.scene().settings.dynamics.subcycles > 1) subcycling_.emplace(model, elements_, inverse_masses);
  }

  /// The subcycling of small elements; null unless the case requests it.
  Subcycling<Real>* subcycling() { return subcycling_ ? &*subcycling_ : nullptr; }

  /// The present number of small steps of small elements in a step.
  int substeps() const { return subcycling_ ? subcycling_->substeps() : 1; }

  /// Sets the step (s) after evaluations from now on.
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
    if (!levels.empty()) gather_elements(layout(), levels);
    archive("element level", levels);
    elements_.set_levels(state_, levels);
    archive("increment step", state_.step);
    archive("free force", force_);
    archive("body reaction", reactions_);
    archive("load factor", load_factor_);
    archive("largest reactions and loads", most_carried_);
    loads_.keep(archive);
    if (subcycling_) subcycling_->keep(archive);
  }

 private:
  /// The rows of all ranks, from ranks that each know their own.
  Rows<Real> of_all(Rows<Real> rows) const {
    layout().gather_rows(rows.data());
    return rows;
  }

  /// Shares the whole kept state among all ranks.
  void gather();

  const InternalForce<Real>& elements_;
  const Scene& scene_;
  RowConstraints<Real> constraints_;
  RowTies<Real> ties_;
  Loads<Real> loads_;
  std::optional<Subcycling<Real>> subcycling_;
  double load_factor_ = 0.0;
  double most_carried_ = 0.0;  // N, at the ends of load levels
  State<Real> state_;
  Rows<Real> force_;
  std::vector<double> reactions_;
};

extern template class Body<double>;
extern template class Body<float>;

}  // namespace sandglass
