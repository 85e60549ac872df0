#pragma once

#include <deque>
#include <string>
#include <vector>

#include "choice/choose.hpp"
#include "comparison/verdict.hpp"
#include "io/result_file.hpp"

namespace sandglass {

/// What `verify` computes.
struct VerifyPlan {
  Precision precision = Precision::double_precision;
  int threads = 0;                                       ///< runs at the same time; 0: one per processor
  bool costs = true;                                     ///< also measure the cost of steps
  std::shared_ptr<const Processor> processor = nullptr;  ///< that computes forces; none: this one
};

/// A scene and its references.
struct VerifiedScene {
  Scene scene;
  References references;
};

/// All runs, their verdicts, and whether the limits of the cases hold.
struct Verification {
  /// One run.
  struct Task {
    const VerifiedScene* of;
    MethodChoice choice;
  };

  /// A method that the processor refuses on a scene.
  struct LeftOut {
    std::string case_name, method, reason;
  };

  std::deque<VerifiedScene> scenes;  // a deque, because tasks point into it
  std::vector<Task> tasks;
  std::vector<Verdict> verdicts;       ///< of the tasks
  std::vector<Displacements> answers;  ///< of the tasks; empty if there is none
  std::vector<LimitCheck> limits;      ///< none in single precision
  std::vector<LeftOut> left_out;       ///< their limits are not checked
};

/// Whether a case has something to be compared with: a static answer, a stored golden, or published values.
bool comparable(const Case& description);

/// Computes every method on every scene that the processor does not refuse, methods with a kappa at `auto`
/// and along the case's kappa curve, and compares with the references; then measures the cost of steps,
/// except in cases with published values. Runs are independent and deterministic; only their order in time is
/// not. Throws InputError for a reference that belongs to another case, and for a scene on which the
/// processor refuses every method; ComputationError if interrupted.
Verification verify(std::vector<Scene> scenes, const VerifyPlan& plan, const ProgressOf& progress);

/// Writes the final state of every run as a result file to a folder, for pictures.
void write_results(const Verification& verification, const std::string& folder, const Provenance& provenance);

}  // namespace sandglass
