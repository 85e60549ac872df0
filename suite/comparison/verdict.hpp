#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparison/accuracy.hpp"
#include "comparison/comparison.hpp"
#include "comparison/finding.hpp"
#include "comparison/published.hpp"
#include "comparison/step_cost.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// What a scene is compared with; stored answers are absent when the case has none.
struct References {
  Comparison comparison;
  std::optional<Displacements> golden;
  std::optional<Displacements> truth;
};

/// Reads the comparison of a scene, and its golden and truth where they exist. Throws InputError when one
/// exists but belongs to another case.
References read_references(const Scene& scene);

/// The accuracy figures of displacements u of a scene against one of its references, if there is one; of a
/// motion the largest over time.
std::optional<Accuracy> accuracy_of(const Scene& scene, const Comparison& comparison, const Displacements& u,
                                    const std::optional<Displacements>& reference);

/// Error of the golden itself, max over all nodes, where there is a truth to tell it by.
std::optional<double> golden_to_truth(const Scene& scene, const References& references);

/// What it took to find a static equilibrium.
struct SearchCost {
  double seconds = 0.0;  ///< wall time, other runs beside
  long evaluations = 0;  ///< of the internal forces
};

/// What it took to follow a motion.
struct MotionCost {
  double seconds = 0.0;  ///< wall time, other runs beside
  long steps = 0;
};

/// What came of one method on one case.
struct Verdict {
  std::string case_name;
  std::size_t elements = 0;  ///< of the case's mesh
  std::string method;
  std::optional<double> kappa;  ///< the number used, none for methods without one
  bool kappa_is_auto = false;
  std::string precision = "double";
  std::string status;  ///< "ok" or "failed: why"
  std::optional<Accuracy> golden;
  std::optional<Accuracy> truth;
  std::optional<Accuracy> twin;  ///< where there is no golden: against its explicit twin, computed for it
  std::optional<Finding>
      finding;  ///< of the worst time; none without a golden, or if the method does not take the case
  std::optional<Symptoms> symptoms;  ///< what it was found by; none for a computation that broke down
  double stable_step = 0.0;          ///< s, at rest; 0 where unknown
  long operations = 0;               ///< per element and step
  double residual = 0.0;
  double hourglass_energy_ratio = 0.0;          ///< hourglass over strain energy
  std::optional<SearchCost> search = {};        ///< of a quasi-static case
  std::optional<MotionCost> motion = {};        ///< of a dynamic case
  std::optional<StepCost> step_cost = {};       ///< measured apart, by benchmark/cost.hpp; else none
  std::string family = {};                      ///< what the case shares with its variants
  std::vector<std::string> variants = {};       ///< of the case
  std::vector<PublishedResult> published = {};  ///< one for each published value of the case

  bool ok() const { return status == "ok"; }
};

/// Computes the scene with a method and compares. A failed computation becomes a status, not an exception.
/// `u` receives the displacements when there are any.
Verdict run_and_compare(const Scene& scene, const References& references, const MethodChoice& choice,
                        Displacements& u);

/// The outcome of one expectation of a case.
struct LimitCheck {
  std::string case_name;
  Expectation expectation;
  std::optional<double> figure;  ///< none when no run gave it
  std::optional<double> kappa;   ///< at which it was found, for "best"
  bool holds = false;
};

/// Compares the verdicts of a case with its expectations, which are for double precision: verdicts in single
/// precision are ignored.
std::vector<LimitCheck> check_limits(const std::string& case_name,
                                     const std::vector<Expectation>& expectations,
                                     const std::vector<Verdict>& verdicts);

}  // namespace sandglass
