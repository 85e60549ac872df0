#pragma once

#include <memory>

#include "assembly/row_ties.hpp"
#include "solve/stable_step.hpp"
#include "solve/substeps.hpp"

namespace sandglass {

/// Small elements and the nodes and elements that take small steps with them. They depend on the nodes that
/// tied nodes follow.
struct Division {
  std::vector<bool> is_small;        ///< nodes of small elements, none of them tied
  std::vector<bool> in_part;         ///< elements that depend on small nodes
  std::vector<bool> on_large_nodes;  ///< elements that depend on other nodes
};

/// Only small elements take small steps, while the others take one large step: the local time stepping of
/// Diaz and Grote (SIAM J. Sci. Comput. 31, 2009), stabilised after Grote, Michel and Sauter (Math. Comp. 90,
/// 2021).
///
/// In every step, small nodes (on which small elements depend) move from zero velocity in small steps, while
/// all others are held. At all nodes, the weighted mean of the forces on the way replaces the force at its
/// start. It is a function of the displacements only, so the rest of a step is as without subcycling. See
/// README.md, "Small steps for small elements".
template <class Real>
class Subcycling {
 public:
  /// Chooses small elements by the undeformed stable steps, so that a second takes the least work, or as a
  /// fixed step of the case demands; none if there is no gain. `elements` are the model's, `inverse_masses`
  /// (1/kg) are zero for nodes that do not move freely. Throws InputError for elements whose forces depend on
  /// more than the displacements of their nodes, and for forces other than dead loads at small elements.
  Subcycling(const Model& model, const InternalForce<Real>& elements, const Rows<Real>& inverse_masses);

  /// Chooses the number of small steps for elements with these stable steps (s): the one with the least work
  /// or, for a given step > 0, the smallest stable one. Returns the stable step.
  StableStep choose_substeps(std::span<const double> element_steps, double given_step);

  /// Sets the step (s) over which forces are averaged from now on.
  void set_step(double step) { step_ = step; }

  /// The number of small steps in a step.
  int substeps() const { return substeps_.count(); }

  /// Replaces the forces (N) at displacements u (m), including tied nodes, by their mean over the small
  /// steps. Allocates nothing. The bits do not depend on the number of threads.
  void average(const Rows<Real>& u, Rows<Real>& force);

  /// The data that the next step depends on; see checkpoint.hpp.
  template <class Archive>
  void keep(Archive& archive) {
    int count = substeps_.count();
    archive("substeps", count);
    archive("averaged step", step_);
    substeps_ = Substeps(count);
  }

 private:
  void build_part(const Model& model, const Layout& layout, const Rows<Real>& inverse_masses);
  void add_to_mean(std::size_t k);
  void move(std::size_t k);

  int most_substeps_;
  Substeps substeps_{1};
  double step_ = 0.0;  // s
  Division division_;
  std::shared_ptr<const InternalForce<Real>> part_;  // the elements that depend on small nodes
  std::vector<std::uint32_t> whole_row_;             // of each row of the part
  RowTies<Real> ties_;                               // of rows of the part to small nodes
  State<Real> state_;                                // of the part
  Rows<Real> mobility_;                              // inverse masses (1/kg) of small nodes, else zero
  Rows<Real> force_;                                 // N, of the part
  Rows<Real> mean_;                                  // N, of the forces of the part
  Rows<Real> rest_;                                  // N, of all but the part
};

extern template class Subcycling<double>;
extern template class Subcycling<float>;

}  // namespace sandglass
