#pragma once

#include "problem/model.hpp"

namespace sandglass {

/// How far an answer is from that of the mean-dilatation element on the same mesh, the explicit twin of the
/// mixed element.
struct ErrorEstimate {
  double largest = 0.0;  ///< over all nodes, m
  double rms = 0.0;      ///< m
  long evaluations = 0;  ///< of the mean-dilatation element's forces, that it took
};

/// The estimate for a quasi-static answer u (m) of any method: the mean-dilatation element is brought towards
/// rest from there, until the forces out of balance, which are those that the methods differ by, have fallen
/// to a hundredth; what is left of them moves nodes by about as small a share of the estimate. Throws
/// ComputationError when the element finds no way on.
ErrorEstimate estimate_error(const Model& model, const NodalField& u);

}  // namespace sandglass
