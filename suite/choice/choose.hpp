#pragma once

#include <optional>
#include <string>
#include <vector>

#include "choice/candidates.hpp"
#include "choice/evaluation.hpp"
#include "comparison/step_cost.hpp"

namespace sandglass {

/// The user's requirements.
struct Demand {
  double tolerance = 0.01;            ///< of the largest imposed displacement, at every node
  std::string against = {};           ///< "golden", "truth", or empty: the golden's own element, computed
  bool real_time = false;             ///< a simulated second must take at most one second
  std::optional<double> budget = {};  ///< the most time of a step or answer, s
  std::vector<std::string> methods = {};
  int threads = 1;
  bool all = false;  ///< try every candidate, not only up to the first that suffices
};

/// The outcome of a candidate.
enum class Outcome { chosen, sufficient, refused, not_tried };

std::string_view name_of(Outcome outcome);

/// A row of the table of candidates.
struct Attempt {
  Candidate candidate;
  std::optional<StepCost> cost = {};
  Evaluation evaluation = {};
  Outcome outcome = Outcome::not_tried;
};

/// A mesh that was tried before any method.
struct MeshAttempt {
  std::string mesh;  ///< its difference from the user's
  Evaluation evaluation = {};
  bool kept = false;
};

/// The result of `choose`.
struct Choice {
  Demand demand;
  Reference reference;
  std::deque<CandidateMesh> meshes;        ///< the meshes of candidates
  std::vector<MeshAttempt> others = {};    ///< all other meshes that were tried
  std::vector<Attempt> attempts = {};      ///< from the cheapest to the costliest; those without a cost last
  std::optional<std::size_t> chosen = {};  ///< index into the attempts; none: nothing suffices
};

/// Receives the stage of the work; returns whether to continue.
using ProgressOf = std::function<bool(double share, const std::string& remark)>;

/// The cheapest way to compute a case that is close enough to the reference at every node, within the limits
/// of time on this machine, and with a reserve of load. Coarser meshes are tried first, with the golden's own
/// element: an answer that is closer than its mesh allows is so by luck, and rejected. For a static answer
/// compared with the truth, meshes that are too coarse are refined where that element errs, until it is close
/// enough. For a motion, meshes are tried with longer steps in the same way (longer_steps.hpp). Then the
/// candidates are timed, put in the order of their cost per simulated second at the mean step of the case's
/// own motion (own_motion.hpp), and tried. Throws InputError for an unknown method or a missing stored
/// reference, ComputationError if the reference has no answer or the user interrupts.
Choice choose(const CaseOnMesh& problem, const Demand& demand, const ProgressOf& progress);

/// A fraction as a percentage with three digits.
std::string percentage(double fraction);

/// Remarks about the choice, or the reasons why nothing suffices, as sentences.
std::vector<std::string> remarks(const Choice& choice);

}  // namespace sandglass
