#pragma once

#include <optional>
#include <string>
#include <vector>

#include "choice/evaluation.hpp"
#include "choice/ladder.hpp"
#include "comparison/step_cost.hpp"

namespace sandglass {

/// What a user asks for.
struct Demand {
  double tolerance = 0.01;            ///< of the largest imposed displacement, at every node
  std::string against = {};           ///< "golden", "truth", or empty: the golden's own element, computed
  bool real_time = false;             ///< a simulated second must take at most one
  std::optional<double> budget = {};  ///< a step or answer may take so long, s
  std::vector<std::string> methods = {};
  int threads = 1;
  bool all = false;  ///< try every rung, not only up to the first that suffices
};

/// What became of a rung.
enum class Outcome { chosen, sufficient, refused, not_tried };

std::string_view name_of(Outcome outcome);

/// One row of the table of what was tried.
struct Attempt {
  Rung rung;
  std::optional<StepCost> cost = {};
  Evaluation evaluation = {};
  Outcome outcome = Outcome::not_tried;
};

/// A mesh that was looked at before any method.
struct MeshAttempt {
  std::string mesh;  ///< its difference from the user's
  Evaluation evaluation = {};
  bool kept = false;
};

/// What `choose` found.
struct Choice {
  Demand demand;
  Reference reference;
  std::deque<LadderMesh> meshes;           ///< those that rungs stand on
  std::vector<MeshAttempt> others = {};    ///< all other meshes that were looked at
  std::vector<Attempt> attempts = {};      ///< from the cheapest to the costliest; those without a cost last
  std::optional<std::size_t> chosen = {};  ///< into the attempts; none: nothing suffices
};

/// Told what is being done, and asked whether to go on.
using ProgressOf = std::function<bool(double share, const std::string& remark)>;

/// The cheapest way to compute a case that is near enough to the reference at every node, within the limits
/// of time on this machine, and with a reserve of load. Coarser meshes are looked at first, with the golden's
/// own element: an answer that is nearer than its mesh allows is so by luck, and not taken. For a static
/// answer that is measured against the truth, meshes that are too coarse are refined where that element errs,
/// until it is near enough. For a motion, meshes are tried with longer steps in the same way
/// (longer_steps.hpp). Then the rungs are timed, put in the order of their cost per simulated second at
/// the mean step of the case's own motion (own_motion.hpp), and climbed. Throws InputError for an unknown
/// method and a stored reference that is not there, ComputationError where the reference finds no answer or
/// when told to end.
Choice choose(const CaseOnMesh& problem, const Demand& demand, const ProgressOf& progress);

/// Why nothing suffices, in sentences; or what is to be known of the choice.
std::vector<std::string> remarks(const Choice& choice);

}  // namespace sandglass
