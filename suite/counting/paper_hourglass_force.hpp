#pragma once

#include "counting/counted.hpp"
#include "mesh/hexahedron.hpp"

namespace sandglass {

/// f = k gamma gamma^T u (eq. 14) as the paper writes it, two dense products: 360 operations. The kernel,
/// `OnePoint::force`, needs fewer; this form is for tests and the operation count.
template <class T>
NodalVectors<T> paper_hourglass_force(const NodalVectors<T>& u, const Matrix<T, 8, 4>& gamma, const T& k) {
  const Matrix<T, 4, 3> q = transpose(gamma) * u;
  return gamma * (k * q);
}

/// The operations of eq. 14 in the paper's form: 360 by its Table I.
inline Operations count_paper_hourglass_force() {
  Operations tally;
  NodalVectors<Counted> u;
  Matrix<Counted, 8, 4> gamma;
  for (auto& entry : u.entries) entry = Counted(1e-3, tally);
  for (auto& entry : gamma.entries) entry = Counted(0.5, tally);
  paper_hourglass_force(u, gamma, Counted(2.0, tally));
  return tally;
}

}  // namespace sandglass
