#pragma once

#include <span>

#include "problem/model.hpp"

namespace sandglass {

/// Groups of constraints that move together, each by one vector: what a user of the response takes hold of.
struct Handles {
  std::size_t count = 0;
  /// For each constraint of the scene its handle, or -1: held where it is.
  std::vector<int> of_constraint;
};

/// One handle for each imposed displacement of the case: its nodes move as they do there, all alike. A node
/// that two of them hold moves with the first; one that only turns has none.
Handles handles_of_sets(const Scene& scene);

/// One handle for each node that has a constraint, in the order of the nodes.
Handles handles_of_nodes(const Scene& scene);

/// Static condensation of a linear model to its driven nodes (Bro-Nielsen and Cotin 1996): with free and
/// driven components f and d, u_f = -K_ff^-1 K_fd u_d, and the forces that this takes are S u_d with S =
/// K_dd - K_df K_ff^-1 K_fd. All answers of the body are superpositions of a few columns, three for each
/// handle, found once; an update is one product with them. It costs what the columns are: 2 operations and
/// one number read for each of 9 x handles x outputs. Imposed forces add a column for each load case, K_ff^-1
/// f with the driven components held.
template <class Real>
class CondensedResponse {
 public:
  using Displacement = std::array<Real, 3>;

  /// Factorises K_ff and finds the columns, in double. `outputs`: the nodes whose displacements are wanted;
  /// `loads`: forces (N) on all nodes, one field for each load case.
  /// Throws InputError when the method is not linear or nothing is imposed, ComputationError when the scene
  /// lets a part of the body move freely.
  CondensedResponse(const Model& model, const Handles& handles, std::vector<int> outputs,
                    const std::vector<NodalField>& loads = {});

  std::size_t handles() const { return handles_; }
  const std::vector<int>& outputs() const { return outputs_; }

  /// Sets u (m) at the outputs for displacements d (m) of the handles; components that no constraint of a
  /// handle holds are left out. `factors` scale the load cases; a factor that is not given is zero. Allocates
  /// nothing; the bits do not depend on the number of threads.
  void displacements(std::span<const Vector> d, std::span<Displacement> u, int threads = 1,
                     std::span<const double> factors = {}) const;

  /// Sets f (N) to the forces that hold the handles there, each the sum over its nodes. Allocates nothing.
  void forces(std::span<const Vector> d, std::span<Vector> f, std::span<const double> factors = {}) const;

  /// The condensed stiffness S (N/m) by rows, 3 x handles square.
  const std::vector<double>& stiffness() const { return stiffness_; }

  /// Operations and bytes of one call of `displacements` and one of `forces`.
  double operations() const;
  double bytes() const;

 private:
  std::size_t columns() const { return 3 * handles_; }

  std::size_t handles_;
  std::size_t loads_;
  std::vector<int> outputs_;
  std::vector<Real> response_;      // by columns, of handles, then loads: the displacements of the outputs
  std::vector<double> stiffness_;   // by rows
  std::vector<double> load_share_;  // by load cases: what the handles carry, N
};

/// All nodes of a scene, in order.
std::vector<int> all_nodes(const Scene& scene);

extern template class CondensedResponse<double>;
extern template class CondensedResponse<float>;

}  // namespace sandglass
