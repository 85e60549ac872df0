#pragma once

#include <optional>
#include <string>

#include "benchmark/measure.hpp"
#include "choice/candidates.hpp"
#include "comparison/finding.hpp"
#include "comparison/reference_file.hpp"

namespace sandglass {

/// The reference of the candidates.
struct Reference {
  std::string name;  ///< "tl-mean-dilatation", "golden" or "truth"
  Displacements u;   ///< m, at the nodes of the user's mesh and the times of its answer
  double unit;       ///< of errors, m: the largest imposed displacement
  OwnError own;      ///< of the truth from the exact answer; of the others from the limit of finer meshes
};

/// The reference of a scene: with `against` "golden" or "truth" the stored one, else the answer of the
/// golden's own element on the user's mesh. Throws InputError if there is none, ComputationError if that
/// element finds no answer.
Reference make_reference(const Scene& scene, const std::string& against, const Proceed& proceed);

/// The error of a candidate's answer, and why it is rejected, if it is.
struct Evaluation {
  std::optional<double> error = {};  ///< max over all nodes of the user's mesh and times, over the unit
  std::optional<double> smallest_jacobian = {};     ///< det F, at the answer
  std::optional<double> per_simulated_second = {};  ///< wall time of the run itself, s; of a motion
  std::string reason = {};                          ///< why it is rejected; empty: good enough
};

/// Compares candidates of one scene with one reference.
class Evaluator {
 public:
  /// `scene` is the user's; it and the reference must outlive the evaluator.
  Evaluator(const Scene& scene, const Reference& reference, double tolerance, const Proceed& proceed);

  /// Computes the candidate's answer and its distance from the reference at all nodes of the user's mesh. A
  /// candidate that is close enough must also find an answer with a tenth more load if the golden's own
  /// element does. Throws ComputationError if interrupted.
  Evaluation evaluate(const Candidate& candidate);

  /// The error of the golden's own element on a mesh: the error due to the mesh, whatever the method.
  Evaluation evaluate_mesh(const CandidateMesh& mesh);

 private:
  /// The evaluation without the reserve.
  Evaluation evaluate_answer(const Candidate& candidate);
  std::string margin_reason(const Candidate& candidate);

  const Scene& scene_;
  const Reference& reference_;
  double tolerance_;
  const Proceed& proceed_;
  double largest_gradient_;  // of displacements, in the reference's elements
};

/// Displacements (m) on a mesh at other points of the same body, at all times.
Displacements interpolate(const Mesh& mesh, const Displacements& history, const NodalField& points);

/// The same case on a coarser mesh, without rules for sets that have no node there; making the scene fails if
/// a table names one.
CaseOnMesh on_mesh(const AnyGenerator& mesh, Case description);

}  // namespace sandglass
