#pragma once

#include "problem/model.hpp"

namespace sandglass {

/// The method for error estimates: eight points and one pressure.
inline constexpr std::string_view estimate_method = "tl-mean-dilatation";

/// The root of the mean squared distance (m) of two fields of the same length.
double rms_distance(const NodalField& a, const NodalField& b);

/// The distance of an answer from that of the mean-dilatation element on the same mesh.
struct ErrorEstimate {
  double largest = 0.0;  ///< over all nodes, m
  double rms = 0.0;      ///< m
  long evaluations = 0;  ///< number of evaluations of the mean-dilatation element's forces
};

/// The estimate for a quasi-static answer u (m) of any method. The mean-dilatation element is relaxed from
/// there until its residual, at first the difference between the two methods' forces, has fallen to a
/// hundredth; the remaining residual displaces nodes by about the same share of the estimate. Throws
/// ComputationError if an element is inverted at u, if the search fails, or with friction.
ErrorEstimate estimate_error(const Model& model, const NodalField& u);

}  // namespace sandglass
