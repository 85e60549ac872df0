#pragma once

#include "problem/model.hpp"

namespace sandglass {

/// The method that errors are estimated with: eight points and one pressure.
inline constexpr std::string_view estimate_method = "tl-mean-dilatation";

/// The distance of an answer from that of the mean-dilatation element on the same mesh.
struct ErrorEstimate {
  double largest = 0.0;  ///< over all nodes, m
  double rms = 0.0;      ///< m
  long evaluations = 0;  ///< number of evaluations of the mean-dilatation element's forces
};

/// The estimate for a quasi-static answer u (m) of any method. The mean-dilatation element is relaxed from
/// there until its residual, at first the difference between the two methods' forces, has fallen to a
/// hundredth; the remaining residual displaces nodes by about the same share of the estimate. Throws
/// ComputationError if an element is inverted at u or the search fails.
ErrorEstimate estimate_error(const Model& model, const NodalField& u);

/// How much of the error of an answer u (m) each element makes, up to a factor: its volume times the mean, over
/// its corners, of the squared distance between its displacement gradient, the mean over the element, and the
/// recovered one, at a node the mean of those of all elements of the same material (Zienkiewicz and Zhu 1987).
std::vector<double> error_indicators(const Scene& scene, const NodalField& u);

/// The fewest elements that together have `share` of the sum of all indicators (Doerfler 1996), by number.
std::vector<int> largest_share(const std::vector<double>& indicators, double share);

/// The distance of an answer from the exact one on the same body: that of ever finer meshes.
struct TruthEstimate {
  double largest = 0.0;       ///< over all nodes, m
  double rms = 0.0;           ///< m
  std::size_t elements = 0;   ///< of the finest mesh
  long evaluations = 0;       ///< of the mean-dilatation element's forces, on all meshes
};

/// The estimate for a quasi-static answer u (m) of any method.
TruthEstimate estimate_truth_error(const Model& model, const NodalField& u);

}  // namespace sandglass
