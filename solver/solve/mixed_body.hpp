#pragma once

#include <algorithm>
#include <optional>

#include "multigrid/saddle_multigrid.hpp"
#include "solve/body.hpp"
#include "solve/drag.hpp"
#include "solve/law_stiffening.hpp"
#include "solve/residual_weights.hpp"

namespace sandglass {

/// A body with pressures as separate unknowns, one for each element. With internal forces f_int, loads f, and
/// J - 1 the mean volume change of an element of volume V, its residuals are
///   R_u = f_int(u) - f + B^T (p - lambda (J - 1)),   R_p = V (J - 1 - p / lambda),
/// B the derivative of V J. In equilibrium p is lambda (J - 1) and R_u the force of the method, whatever its
/// volumetric law; but no step has to follow the narrow valley of nearly incompressible motions.
template <class Real>
class MixedBody {
 public:
  /// The undeformed body of the model, linearized; `weigh` must follow.
  MixedBody(const Model& model, const InternalForce<Real>& elements);

  /// The body, with the forces of the last evaluation.
  Body<Real>& body() { return body_; }
  const Body<Real>& body() const { return body_; }

  /// Pressures of the elements, Pa.
  std::vector<Real>& pressures() { return p_; }
  const std::vector<Real>& pressures() const { return p_; }

  /// Whether the method's forces are linear in the displacements.
  bool is_linear() const { return linear_; }

  /// Whether the method resists volume changes other than by one pressure for each element; the pressures
  /// here can carry no more.
  bool pressure_varies() const { return pressure_varies_; }

  /// Whether the stiffening of a law is known.
  bool may_stiffen() const { return stiffening_.is_known(); }

  /// Adapts the multigrid method to the present configuration, unless it has hardly changed since the last
  /// time; no element may be inverted.
  void linearize() { linearize(INFINITY); }

  /// Adapts it only to the nodes that touch obstacles now, unless they are the same as the last time.
  void linearize_contact();

  /// Lets residuals replace the drags of the nodes that slip now; see drag.hpp.
  void set_drags();

  /// The same with the resistance to volume changes of multipliers with this penalty.
  void linearize(double penalty);

  /// Sets the weights of the residuals from the last linearized configuration; weighted, both have the unit
  /// of a root of energy.
  void weigh();

  /// Evaluates forces and residuals.
  void evaluate();

  /// Evaluates residuals from the forces of the last evaluation.
  void compare();

  /// change = the tangent stiffness times displacements (m): N, a finite difference over `length` times
  /// these, with one evaluation. Elements resist volume changes by lambda up to so many shear moduli, or by
  /// all of it if pressures vary within elements. The body stays at the last evaluation.
  void differentiate(const MixedVector& direction, double length, double most_lambda_over_mu,
                     Rows<float>& change);

  /// Weighted residuals of the last evaluation, root of J.
  const MixedVector& residuals() const { return residuals_; }

  /// Their norm.
  double norm() const { return std::sqrt(dot(residuals_, residuals_, multigrid_.elements().blocks())); }

  /// Body::residual of the last evaluation.
  double residual() const { return residual_; }

  /// Whether the remaining residuals may be rounding of the displacements and of the arithmetic: in both
  /// unknowns, or only in the displacements. See README.md, "Rounding".
  bool at_rounding(bool in_both);

  /// Whether reactions and loads may also be rounding at the undeformed body's stiffest node: the body bears
  /// nothing.
  bool bears_nothing() const;

  /// step = minus an approximate solution of the linear problem for weighted residuals.
  void correct(const MixedVector& weighted, MixedVector& step);

  /// z = an approximate solution for forces r alone, positive definite, for conjugate gradients on
  /// displacements.
  void precondition(const MixedVector& r, MixedVector& z);

  /// Weights residuals in place.
  void weigh(MixedVector& residuals) const { weights_.multiply(residuals, multigrid_.elements().blocks()); }

  /// Adds `share` times a step to both unknowns, m and Pa.
  void move(const MixedVector& step, double share);

  /// Sets the pressures to lambda (J - 1) at the present displacements.
  void take_own_pressures();

  /// Sets the pressures to their means over the elements of a coarser mesh; element_of has the coarser
  /// element of each. With interpolated displacements, the volume changes of an element's parts are
  /// unrealistic, but their mean is not.
  void average_pressures(const std::vector<int>& element_of);

  /// Instead of an element's own resistance to volume changes, lambda (J - 1), a constant pressure and a
  /// lambda reduced by a penalty of so many shear moduli: 1 / (1 / lambda + 1 / penalty). The forces are
  /// those of an augmented Lagrangian.
  struct Multipliers {
    std::vector<Real> pressures;   ///< of elements, Pa
    double penalty;                ///< in shear moduli
    std::vector<double> given_up;  ///< of lambda, by material, Pa
  };

  /// Multipliers that do not change the forces at the present pressures.
  Multipliers multipliers(double penalty) const;

  /// Sets `f` to the forces (N) with multipliers, zero on constrained components; null: the body's own
  /// forces.
  void evaluate(const Multipliers* multipliers, Rows<Real>& f);

  /// The potential (J) of these forces at the last evaluation: energy minus the work of the loads.
  double potential(const Multipliers* multipliers) const;

  /// Sets the pressures to the values of the last evaluation with multipliers.
  void take_pressures(const Multipliers& multipliers);

  SaddleMultigrid& multigrid() { return multigrid_; }
  const SaddleMultigrid& multigrid() const { return multigrid_; }

  /// 1, or 0 on constrained components and in spare rows.
  const Rows<Real>& free() const { return free_; }

  /// Evaluations of the forces since construction.
  long evaluations() const { return evaluations_; }

  /// The data that the next load level depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    body_.layout().gather_rows(linearized_at_.data());
    archive("evaluations", evaluations_);
    archive("linearized at", linearized_at_);
    archive("linearized with a penalty", linearized_penalty_);
    if (may_touch()) {
      Rows<float> rows = rows_of(contact_, most_springs_);
      archive("linearized contact", rows);
      contact_ = springs_of(rows);
      multigrid_.set_contact(contact_);
    }
    linearized_ = false;
    body_.keep(archive);
  }

 private:
  double volume(std::size_t element) const {
    return static_cast<double>(multigrid_.elements().tangents()[cell(element)].volume);
  }
  bool may_touch() const { return most_springs_ > 0; }
  void evaluate_forces();
  void update_multigrid();

  /// Whether nodes have touched obstacles, or left them, since the last linearization.
  bool contact_changed();
  void slide();

  /// The sum over all components of a term of the stiffness (N/m) and the displacement (m).
  template <class Term>
  double sum_over_components(const Term& term) const;

  /// See InternalForce::replace_pressures.
  void replace_pressures(const std::vector<Real>& pressures, const std::vector<double>& lambdas);

  /// The reduced lambda (Pa) of a penalty, by material.
  std::vector<double> remaining(double penalty) const;
  double lambda(std::size_t element) const { return moduli_[materials_.of(element)].lambda; }

  /// J - 1 of an element from its defect with multipliers.
  double volume_change(std::size_t element, const Multipliers& multipliers) const {
    return static_cast<double>(defect_[element]) / volume(element) +
           static_cast<double>(multipliers.pressures[element]) / multipliers.given_up[materials_.of(element)];
  }

  std::size_t cell(std::size_t element) const { return multigrid_.elements().cells()[element]; }

  /// Calls body(e, cell) for the elements that this rank computes, in parallel.
  template <class Function>
  void for_each_element(const Function& body) const {
    multigrid_.elements().blocks().p.for_each([&](std::size_t first, std::size_t last) {
      for (std::size_t c = first; c < last; ++c) {
        const int e = body_.layout().elements[c];
        if (e >= 0) body(static_cast<std::size_t>(e), c);
      }
    });
  }

  const InternalForce<Real>& elements_;
  Body<Real> body_;
  const Materials& materials_;
  std::vector<ModelModuli> moduli_;  // of each material
  LawStiffening stiffening_;
  std::vector<double> lambdas_;  // Pa
  double unfelt_ = 0.0;          // N/m, reactions over displacements that may be rounding
  double farthest_;              // m, displacements of a body that does not fly away
  bool linear_;
  bool pressure_varies_;
  Rows<Real> free_;
  SaddleMultigrid multigrid_;
  Rows<float> linearized_at_;                  // m
  double linearized_penalty_ = 0.0;            // zero before the first time
  Rows<Real> before_, slid_;                   // displacements before and after nodes slide along obstacles
  std::size_t most_springs_;                   // of contact
  std::vector<Spring> contact_, contact_now_;  // linearized and present
  std::vector<Drag> drags_;                    // in residuals
  bool linearized_ = false;                    // whether the multigrid method belongs to these two
  std::vector<Real> p_;
  std::vector<Real> defect_;  // R_p
  Rows<Real> pressure_force_;
  ResidualWeights weights_;
  MixedVector residuals_, scratch_;
  double residual_ = 0.0;
  long evaluations_ = 0;
};

extern template class MixedBody<double>;
extern template class MixedBody<float>;

}  // namespace sandglass
