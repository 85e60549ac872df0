#pragma once

#include "problem/model.hpp"

namespace sandglass {

/// How much of the error of an answer u (m) each element makes, up to a factor: its volume times the mean,
/// over its corners, of the squared distance between its displacement gradient, the mean over the element,
/// and the recovered one: at a node the mean of those of all elements of the same material (Zienkiewicz and
/// Zhu 1987).
std::vector<double> error_indicators(const Scene& scene, const NodalField& u);

/// The fewest elements that together have `share` of the sum of all indicators, by their numbers (Doerfler
/// 1996).
std::vector<int> largest_share(const std::vector<double>& indicators, double share);

/// An answer of the mean-dilatation element on a refined mesh.
struct RefinedAnswer {
  Scene scene;
  NodalField u;          ///< m
  long evaluations = 0;  ///< on this mesh and those before
  double seconds = 0.0;  ///< wall time for them
};

/// Meshes that are refined step by step where the mean-dilatation element's answer needs it.
class Refining {
 public:
  /// Starts from the element's answer on the scene's mesh, near u (m) if that is given. Throws
  /// ComputationError if there is none.
  Refining(const Scene& scene, const NodalField* near, int threads);

  /// Splits the elements that make most of the error, and finds the answer on the finer mesh, near the last
  /// one or, where that is no good start, from rest. Throws ComputationError if there is none; the answer is
  /// then still the last one.
  void refine();

  /// The answer on the finest mesh.
  const RefinedAnswer& answer() const { return answer_; }

  /// The part of a field at the nodes of the scene's mesh, which are the first ones of every refined mesh.
  NodalField on_original(const NodalField& u) const;

  /// The exact displacements (m) at the original nodes, as the last two answers let expect them; before any
  /// refinement those of the answer.
  NodalField limit() const;

  /// How far the answer on the finest mesh is from that limit, m: the largest distance. Before any refinement
  /// it is infinite.
  double error() const;

 private:
  int threads_;
  std::size_t nodes_;  // of the scene's mesh
  RefinedAnswer answer_;
  NodalField before_;  // the answer on the mesh before, m
};

/// The distance of an answer from the exact one on the same body, which ever finer meshes would have.
struct TruthEstimate {
  double largest = 0.0;      ///< over all nodes, m
  double rms = 0.0;          ///< m
  std::size_t elements = 0;  ///< of the finest mesh
  std::string remark = {};   ///< why the mesh was not refined as often as it should be; empty: it was
};

/// The estimate for a quasi-static answer u (m) of any method, from meshes that are refined twice. Throws
/// ComputationError where not even one of them has an answer.
TruthEstimate estimate_truth_error(const Model& model, const NodalField& u);

}  // namespace sandglass
