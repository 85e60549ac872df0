#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "solve/acceleration.hpp"
#include "solve/mixed_body.hpp"
#include "solve/softest_motions.hpp"

namespace sandglass {

/// When a search gives up if its steps fail: immediately, after a while, or only after all stages.
enum class Effort { brief, patient, full };

/// Whether forces depend on the load levels before: those of elements, or friction.
template <class Real>
bool depends_on_path(const Model& model, const InternalForce<Real>& elements) {
  return elements.needs_increment() || remember_path(model.scene().forces);
}

/// The search for the equilibrium of a body at fixed loads and imposed displacements, in up to three stages:
/// accelerated steps, each a multigrid cycle and one evaluation of the forces; if they fail, the method of
/// multipliers; if that is no better, descent of the body's own potential. See README.md.
template <class Real>
class Equilibrium {
 public:
  /// For the undeformed body of the model; `start` must follow.
  Equilibrium(const Model& model, const InternalForce<Real>& elements)
      : mixed_(model, elements),
        acceleration_(blocks()),
        depends_on_path_(depends_on_path(model, elements)) {}

  /// The body, with the forces and displacements of the last evaluation. Callers that move it must set its
  /// increment.
  Body<Real>& body() { return mixed_.body(); }
  const Body<Real>& body() const { return mixed_.body(); }

  /// Pressures of the elements, Pa.
  std::vector<Real>& pressures() { return mixed_.pressures(); }

  /// Sets the pressures to the values at the present displacements.
  void take_own_pressures();

  /// See MixedBody::average_pressures.
  void average_pressures(const std::vector<int>& element_of) { mixed_.average_pressures(element_of); }

  /// Imposes a load and moves the body by the linear answer to its increase. Scales both down if an element's
  /// displacement gradient would change by more than `most`. Returns the load.
  double extend(double load, double most);

  /// Whether there are obstacles, so that motions before they touch do not predict those after it.
  bool may_touch() const { return !contacts_of(body().scene().forces).empty(); }

  /// Whether no fixed contact is contrary to the last evaluation: otherwise nodes are pulled or inside of
  /// obstacles.
  bool contact_agrees() const { return body().touch().contrary == 0; }

  /// Evaluates the forces with the nodes that touch obstacles now, if these have changed. Accelerated steps
  /// keep them fixed until the norm has fallen, so that forces are smooth; an answer must have those that
  /// touch.
  void update_contact();

  /// The factor by which `change` (m) may be scaled until an element of the current configuration is strained
  /// by `most`; infinite if laws are not known to stiffen.
  double steps_to_strain(const Rows<float>& change, double most) {
    if (!mixed_.may_stiffen()) return INFINITY;
    mixed_.linearize();
    return most / mixed_.multigrid().elements().largest_strain(change);
  }

  /// Starts from the current displacements and pressures, at which no element may be inverted, with one
  /// evaluation. Later stages descend a potential, so forces must have one.
  void start(Effort effort);

  /// Takes one step with one evaluation, or more in later stages; false if the search fails.
  bool step();

  /// The body's softest small motions at the last evaluation, which must be an answer.
  SoftestMotions softest_motions(const NodalField& points);

  /// Leaves a saddle along the motions that lower the potential, to its smallest value along them or
  /// combinations of the first two; `step` descends further, down the body's own potential if `slowly`.
  /// Returns false if no motion lowers it.
  bool leave(const std::vector<MixedVector>& falling, bool slowly);

  /// The residual of the last evaluation; see Body::residual.
  double residual() const { return mixed_.residual(); }

  /// See MixedBody.
  bool at_rounding() { return mixed_.at_rounding(stage_ != Stage::descent); }
  bool bears_nothing() const { return mixed_.bears_nothing(); }

  /// The norm of the residuals of both unknowns over its initial value; 1 in the last stage, which has no
  /// pressures, and after steps have failed, when a body with a small norm may have collapsed.
  double reduction() const { return returns_ > 0 || stage_ == Stage::descent ? 1.0 : mixed_.norm() / first_; }

  /// Evaluations of the forces since construction.
  long evaluations() const { return mixed_.evaluations(); }

  /// The data that `start` depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    mixed_.keep(archive);
  }

 private:
  enum class Stage { acceleration, multipliers, descent };

  /// The unknowns of a step.
  struct Point {
    State<Real> state;
    std::vector<Real> pressures;
  };

  /// The steps in which a norm must fall to a share of itself.
  struct Patience {
    double share;
    int steps;
  };

  /// Watches whether a norm keeps falling.
  struct Progress {
    double fallen = 0.0;
    int waited = 0;

    /// Counts a step; returns whether the norm has fallen in time.
    bool take(double norm, const Patience& patience);
  };

  /// The updates of touching nodes since acceleration began.
  struct ContactUpdates {
    double norm = 0.0, share = 0.0;  // after the last one, and by which it falls before the next
    int fewest = std::numeric_limits<int>::max(), failed = 0, updates = 0, steps = 0;
  };

  /// The patience of the descent: a buckling body descends far before its norm falls, and near the answer
  /// slow steps are as good as any.
  static constexpr Patience accelerated_patience{0.75, 12}, patient_patience{0.5, 100},
      multiplied_patience{0.5, 100}, descent_patience{0.5, 300};

  const MixedBlocks& blocks() const { return mixed_.multigrid().elements().blocks(); }
  void begin();
  void begin_acceleration();
  void begin_multipliers();
  void begin_descent();
  bool accelerated();
  bool multiplied();
  bool descended();
  bool linearized_step();
  void go_to(const Point& point);
  void go_to_lower();
  double potential_at(const Point& point);

  MixedBody<Real> mixed_;
  Acceleration acceleration_;
  bool depends_on_path_;
  MixedVector step_, correction_, reduced_;
  Effort effort_ = Effort::brief;
  Stage stage_ = Stage::acceleration;
  Progress progress_;
  ContactUpdates contact_;
  Point start_, best_;
  double best_norm_ = 0.0;
  double first_ = 1.0;   // norm
  double enough_ = 0.0;  // norm at which multipliers end
  int returns_ = 0;      // to acceleration
  bool leaves_saddle_ = false;
  bool convex_ =
      true;  // whether the last Newton step met no negative curvature; only used after leaving a saddle
  std::vector<double> norms_;  // since acceleration began
};

extern template class Equilibrium<double>;
extern template class Equilibrium<float>;

}  // namespace sandglass
