#pragma once

#include "problem/make_scene.hpp"

namespace sandglass {

/// An indicator (m^3) of each element's contribution to the squared error of an answer u (m): its volume
/// times the mean, over the corners, of the squared distance between the element's mean displacement gradient
/// and the recovered gradient at the corner, which is the mean over all elements of the same material at that
/// node (Zienkiewicz and Zhu 1987).
std::vector<double> error_indicators(const Scene& scene, const NodalField& u);

/// The numbers of the fewest elements that together have `share` of the sum of all indicators (Doerfler
/// 1996).
std::vector<int> largest_share(const std::vector<double>& indicators, double share);

/// The mean-dilatation element's answers on a mesh and on meshes that are refined where it errs most.
class RefinedAnswer {
 public:
  /// Starts on the mesh of a quasi-static case, near u (m) if that is given. Searches end at a residual of a
  /// tenth of `accuracy`, or the case's own if larger; a smaller residual would not reduce the error. Throws
  /// ComputationError if there is no answer.
  RefinedAnswer(CaseOnMesh problem, double accuracy, int threads, const NodalField* near = nullptr);

  /// Refines the mesh once more. Throws ComputationError and changes nothing if the finer mesh has no answer.
  void refine();

  const CaseOnMesh& problem() const { return problem_; }
  const Scene& scene() const { return scene_; }
  const NodalField& u() const { return u_; }

  /// The exact displacements (m) at the original nodes, which come first on every mesh, extrapolated from the
  /// last two answers. Needs at least one refinement.
  NodalField limit() const;

 private:
  int threads_;
  std::size_t original_nodes_;
  CaseOnMesh problem_;
  Scene scene_;
  NodalField u_, before_;  // on the last mesh, and on the one before
};

/// A mesh that is fine enough for an accuracy, and the answer on it.
struct AccurateMesh {
  CaseOnMesh problem;
  Scene scene;
  NodalField u;      ///< the mean-dilatation element's answer, m
  NodalField limit;  ///< the estimate of the exact displacements at the original nodes, m
  double seconds;    ///< wall time to find it
};

/// Refines the mesh of a quasi-static case until the estimated error of the mean-dilatation element's answer
/// at every original node is at most `accuracy` times the unit of errors (`displacement_unit`). A mesh that
/// is fine enough is not refined. Searches for equilibrium end at a residual of a tenth of `accuracy`; a
/// smaller one would not reduce the error. Throws ComputationError, with the best estimate, if a mesh of more
/// than `most_elements` elements would be refined or a mesh has no answer.
AccurateMesh refine_until_within(double accuracy, const CaseOnMesh& problem, int threads,
                                 std::size_t most_elements = 1'000'000);

/// The distance of an answer from the exact one, the limit of ever finer meshes.
struct TruthEstimate {
  double largest = 0.0;      ///< over all nodes, m
  double rms = 0.0;          ///< m
  std::size_t elements = 0;  ///< of the finest mesh
  std::string remark = {};   ///< why the mesh was refined only once; empty: it was refined twice
};

/// The estimate for a quasi-static answer u (m) of any method. The mean-dilatation element is solved on the
/// mesh and on two meshes that are refined where its error indicators are largest; its answer is extrapolated
/// from the last two. Throws ComputationError if it has no answer on the first of the refined meshes.
TruthEstimate estimate_truth_error(const CaseOnMesh& problem, int threads, const NodalField& u);

}  // namespace sandglass
