#pragma once

#include <limits>

#include "assembly/internal_force.hpp"

namespace sandglass::verification {

/// The elements of a mesh in double precision, moved along a path of displacements step by step: for methods
/// with memory.
class Path {
 public:
  Path(const Mesh& mesh, const AnyLaw& law, const MethodChoice& choice, double density = 1000.0)
      : elements_(std::get<0>(make_internal_force(mesh, law, choice, density))),
        state_(elements_->undeformed()) {}

  /// Moves to displacements u (m) in a time `step` (s), by default so long that it plays no part, and returns
  /// the forces there (N).
  NodalField to(const NodalField& u, double step = std::numeric_limits<double>::infinity()) {
    state_.step = step;
    const Rows<double> rows = to_rows<double>(u, elements_->layout());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t i = 0; i < 3; ++i) state_.increment[r][i] = rows[r][i] - state_.u[r][i];
    }
    state_.u = rows;
    Rows<double> force(rows.size());
    elements_->evaluate(state_, force);
    return to_field(force, elements_->layout());
  }

 private:
  std::unique_ptr<InternalForce<double>> elements_;
  State<double> state_;
};

}  // namespace sandglass::verification
