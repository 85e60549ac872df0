#pragma once

#include <span>

#include "problem/model.hpp"

namespace sandglass {

/// Groups of constraints that move together, each by one vector.
struct Handles {
  std::size_t count = 0;
  /// For each constraint of the scene its handle, or -1 if it is fixed.
  std::vector<int> of_constraint;
};

/// One handle for each imposed displacement of the case, whose nodes all move alike. A node that belongs to
/// two of them moves with the first; a node with only an imposed rotation has none.
Handles handles_of_sets(const Scene& scene);

/// One handle for each node that has a constraint, in the order of the nodes.
Handles handles_of_nodes(const Scene& scene);

/// The displacements (m) of handles at the full load; components that nothing imposes are zero.
std::vector<Vector> final_displacements(const Scene& scene, const Handles& handles);

/// Static condensation of a linear model to its driven nodes (Bro-Nielsen and Cotin 1996): with free and
/// driven components f and d, u_f = -K_ff^-1 K_fd u_d, and the forces on the driven components are S u_d with
/// S = K_dd - K_df K_ff^-1 K_fd. All answers of the body are superpositions of a few columns, three per
/// handle, computed once; an update is one product with them, which takes 2 operations and one number read
/// for each of its 9 x handles x outputs entries. Imposed forces add a column for each load case, K_ff^-1 f
/// with the driven components fixed.
template <class Real>
class CondensedResponse {
 public:
  using Displacement = std::array<Real, 3>;

  /// Factorises K_ff and computes the columns, in double precision. `outputs` are the nodes whose
  /// displacements are computed, `loads` forces (N) on all nodes, one field for each load case. Throws
  /// InputError if the method is not linear or no displacement is imposed, ComputationError if a part of the
  /// body is free to move.
  CondensedResponse(const Model& model, const Handles& handles, std::vector<int> outputs,
                    const std::vector<NodalField>& loads = {});

  std::size_t handles() const { return handles_; }
  const std::vector<int>& outputs() const { return outputs_; }

  /// Sets u (m) at the outputs for displacements d (m) of the handles; components without a constraint of a
  /// handle are ignored. `factors` scale the load cases; missing ones are zero. Allocates nothing; the bits
  /// do not depend on the number of threads.
  void displacements(std::span<const Vector> d, std::span<Displacement> u, int threads = 1,
                     std::span<const double> factors = {}) const;

  /// Sets f (N) to the forces on the handles, each the sum over its nodes, for the same arguments. Allocates
  /// nothing.
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
  std::vector<Real> response_;      // displacements of the outputs, by columns of handles, then of loads
  std::vector<double> stiffness_;   // by rows
  std::vector<double> load_share_;  // forces of the handles, N, by load cases
};

/// All nodes of a scene, in order.
std::vector<int> all_nodes(const Scene& scene);

extern template class CondensedResponse<double>;
extern template class CondensedResponse<float>;

}  // namespace sandglass
