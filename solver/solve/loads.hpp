#pragma once

#include "assembly/internal_force.hpp"
#include "forces/contact_force.hpp"
#include "problem/observer.hpp"
#include "problem/scene.hpp"

namespace sandglass {

/// The forces of a scene on the rows of a body.
template <class Real>
class Loads {
 public:
  Loads(const Scene& scene, const Layout& layout);

  /// The factors of all curves at a time and load factor, as `set` sets them.
  std::vector<double> factors_at(double time, double load_factor) const;

  /// Sets the factors of all curves, at a time (s, or the share of a quasi-static load) and a load factor.
  void set(double time, double load_factor);

  /// The number of displacements by which a program may move obstacles: three for each.
  std::size_t moves() const { return 3 * movable_.size(); }

  /// Sets these displacements, m; `set` makes them zero.
  void move_obstacles(std::span<const double> moves);

  /// Evaluates the loads of a state and subtracts them from its forces (N).
  void subtract(const State<Real>& state, Rows<Real>& force);

  /// Subtracts the derivatives of the power of the loads at velocities w, by displacements and by increments;
  /// see BodyForce::add_derivatives_of_power.
  void subtract_derivatives_of_power(const State<Real>& state, const Rows<Real>& w, Rows<Real>& by_u,
                                     Rows<Real>& by_increment) const;

  /// Lets obstacles move nodes within a step; see ContactForce::push_out. Returns whether there are such
  /// obstacles.
  bool push_out(State<Real>& state, const Rows<Real>& inverse_masses, double gain);

  /// Subtracts from forces (N), by row, those with which obstacles moved nodes in the last step.
  void subtract_pushes(Rows<Real>& force) const;

  /// What was lost (J) as contact moved nodes: the work of obstacles less that done on nodes.
  double lost_by_pushes() const;

  /// The square of the norm of the loads (N^2) that were last evaluated.
  double square() const { return square_; }

  /// The change of the loads (N) to another time and load factor, by row, in the configuration u (m).
  Rows<Real> change_to(double time, double load_factor, const Rows<Real>& u) const;

  /// The potential (J) of the loads at displacements u (m); they are minus its derivative. See
  /// BodyForce::add_potential.
  double potential(const Rows<Real>& u) const;

  /// See ContactForce::slide.
  void slide(const Rows<Real>& before, Rows<Real>& u) const;

  /// See ContactForce::begin_again, with the forces and moments of obstacles by name.
  void begin_again(const Reactions& forces, const Reactions& moments);

  /// See ContactForce::fix_contact.
  void fix_contact(Fixing fixing);

  /// See ContactForce::augment; of all obstacles.
  bool augment_contact(Augmentation augmentation);

  /// See ContactForce::end_level; at displacements u (m). Returns how a node touches that may have passed
  /// through; then the level has not ended.
  Touch end_level(const Rows<Real>& u, bool may_shorten);

  /// Changes one node of all obstacles; see ContactForce::correct_contact.
  void correct_contact();

  /// The factor by which a change of displacements (m, by row) may be scaled until the surfaces of a pair
  /// move relative to each other by half of the depth up to which they find each other; infinite without
  /// pairs.
  double share_in_reach(const Rows<float>& change) const;

  /// The springs of contact by row; see ContactForce::add_springs.
  std::vector<Spring> springs_of_contact(const Rows<Real>& u) const;

  /// Calls use(touch) with how the body touched each obstacle at the last evaluation.
  template <class Use>
  void for_each_touch(const Use& use) const {
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      use(contacts_[c]->touch(memory_.data() + memory_of_[c]));
  }

  /// Adds the work of the loads since the last call, from the mean of the forces of both states: for
  /// obstacles, of their own motion.
  void add_work(const Rows<Real>& u);

  /// The sum of all work added, J.
  double work() const;

  /// The loads (N) that were last evaluated, by row, of which there are `rows`; without contacts.
  Rows<Real> by_row(std::size_t rows) const;

  /// Continues from displacements (m) and loads (N) of another processor, which did this work (J) since the
  /// last call of this or of `add_work`; all by row, without contacts.
  void follow(const Rows<Real>& u, const Rows<Real>& loads, std::span<const Real> works);

  /// Makes the complete data known to all ranks.
  void gather();

  /// The data that the next work depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    archive("factors of curves", factors_);
    archive("loads", forces_);
    archive("loads before", forces_before_);
    archive("loaded displacements before", u_before_);
    archive("work of loads", work_);
    if (contacts_.empty()) return;
    archive("memory of contacts", memory_);
    archive("memory of contacts before", memory_before_);
    archive("work of obstacles", work_of_obstacles_);
    if (!moves_nodes_) return;
    archive("increments before", last_increment_);
    archive("pushes", pushes_of_step_);
    archive("work of pushes", work_of_pushes_);
    archive("has pushed", has_pushed_);
  }

 private:
  /// Loaded rows by nodes.
  template <class T>
  AtNodes<T> by_node(T* loaded) const {
    return {loaded, place_of_node_};
  }

  /// Sets the values of the first loaded rows to those of all rows.
  void take(const Rows<Real>& all, Rows<double>& loaded) const;
  Rows<double> loaded(const Rows<Real>& all) const;

  /// Sets the values at loaded rows that other ranks own.
  void gather(std::span<double> values) const;

  const std::vector<LoadCurve>& curves_;
  std::vector<const BodyForce*> loads_;  // all except obstacles
  std::vector<const ContactForce*> contacts_;
  bool moves_nodes_, pushes_;           // whether any of them moves nodes, or adds forces
  std::vector<std::size_t> memory_of_;  // first row of each
  std::vector<std::size_t> rows_;       // that carry loads: first those whose loads are not all dead
  std::vector<bool> owned_;             // by this rank, of these
  std::shared_ptr<const Ranks> ranks_;
  std::vector<int> place_of_node_;       // among the loaded rows; -1 for others
  bool all_dead_;                        // no force depends on the motion, except by moving nodes
  std::vector<double> factors_;          // of curves
  std::vector<Movable> movable_;         // obstacles
  Rows<double> u_, increment_;           // m, of the first rows, on which they may depend
  Rows<double> forces_;                  // N, of loaded rows, except those of obstacles
  Rows<double> touching_;                // N, those, of the first rows; empty without any
  Rows<double> masses_;                  // 1/kg, inverse, of the first rows; empty without obstacles
  Rows<double> pushes_of_step_;          // N, of the first rows; empty if none moves nodes
  Rows<double> last_increment_;          // m, of these rows in the last step
  double has_pushed_ = 0.0;              // whether there was a last step
  double work_of_pushes_ = 0.0;          // J
  Rows<double> memory_, memory_before_;  // of contacts
  double work_of_obstacles_ = 0.0;       // J
  Rows<double> forces_before_, u_before_;
  std::vector<double> work_;  // J, of loaded rows
  double square_ = 0.0;
};

extern template class Loads<double>;
extern template class Loads<float>;

}  // namespace sandglass
