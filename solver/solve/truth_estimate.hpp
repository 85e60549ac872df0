#pragma once

#include "problem/model.hpp"

namespace sandglass {

/// An indicator (m^3) for each element of how much it contributes to the squared error of an answer u (m). It
/// is the volume times the mean, over the corners, of the squared distance between the element's mean
/// displacement gradient and the recovered gradient at the corner, which is the mean over all elements of the
/// same material that share the node (Zienkiewicz and Zhu 1987).
std::vector<double> error_indicators(const Scene& scene, const NodalField& u);

/// The fewest elements that together have `share` of the sum of all indicators, by their numbers (Doerfler
/// 1996).
std::vector<int> largest_share(const std::vector<double>& indicators, double share);

/// The distance of an answer from the exact one on the same body, the limit of ever finer meshes.
struct TruthEstimate {
  double largest = 0.0;      ///< over all nodes, m
  double rms = 0.0;          ///< m
  std::size_t elements = 0;  ///< of the finest mesh
  std::string remark = {};   ///< why the mesh was refined only once; empty: it was refined twice
};

/// The estimate for a quasi-static answer u (m) of any method. The mean-dilatation element is solved on the
/// mesh and on two meshes that are refined where its error indicators are largest; its answer is extrapolated
/// from the last two. Throws ComputationError if it has no answer on the first of the refined meshes.
TruthEstimate estimate_truth_error(const Model& model, const NodalField& u);

}  // namespace sandglass
