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

/// The references of a scene; stored answers are absent if the case has none.
struct References {
  Comparison comparison;
  std::optional<Displacements> golden;
  std::optional<Displacements> truth;
};

/// Reads the comparison of a scene, and its golden and truth if they exist. Throws InputError if one exists
/// but belongs to another case.
References read_references(const Scene& scene);

/// The accuracy of displacements u of a scene against one of its references, if there is one; for a motion
/// the largest errors over time.
std::optional<Accuracy> accuracy_of(const Scene& scene, const Comparison& comparison, const Displacements& u,
                                    const std::optional<Displacements>& reference);

/// The error of the golden itself, max over all nodes; none without a truth.
std::optional<double> golden_to_truth(const Scene& scene, const References& references);

/// The cost of finding a static equilibrium.
struct SearchCost {
  double seconds = 0.0;  ///< wall time, while other runs share the machine
  long evaluations = 0;  ///< of the internal forces
};

/// The cost of computing a motion.
struct MotionCost {
  double seconds = 0.0;  ///< wall time, while other runs share the machine
  long steps = 0;
};

/// The result of one method on one case.
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
  std::optional<Accuracy> mean_dilatation;  ///< without a golden: against tl-mean-dilatation, computed here
  std::optional<Finding>
      finding;  ///< at the worst time; none without a golden, or if the method does not support the case
  std::optional<Symptoms> symptoms;     ///< the basis of the finding; none for a computation that broke down
  double stable_step = 0.0;             ///< s, of the undeformed body; 0 if unknown
  long operations = 0;                  ///< per element and step, without loads
  std::string_view load_in_steps = {};  ///< table of the first load that steps compute; empty if none does
  double residual = 0.0;
  double hourglass_energy_ratio = 0.0;          ///< hourglass over strain energy
  std::optional<SearchCost> search = {};        ///< of a quasi-static case
  std::optional<MotionCost> motion = {};        ///< of a dynamic case
  std::optional<StepCost> step_cost = {};       ///< measured separately by benchmark/cost.hpp; else none
  std::string family = {};                      ///< the name that the case shares with its variants
  std::vector<std::string> variants = {};       ///< of the case
  std::vector<PublishedResult> published = {};  ///< one for each published value of the case

  bool ok() const { return status == "ok"; }
};

/// Computes the scene with a method and compares. A failed computation becomes a status, not an exception.
/// `u` receives the displacements, if there are any.
Verdict run_and_compare(const Scene& scene, const References& references, const MethodChoice& choice,
                        Displacements& u);

/// The outcome of one expectation of a case.
struct LimitCheck {
  std::string case_name;
  Expectation expectation;
  std::optional<double> figure;  ///< none if no run provides it
  std::optional<double> kappa;   ///< that gave the figure, for "best"
  bool holds = false;
};

/// Compares the verdicts of a case with its expectations. These are for double precision; verdicts in single
/// precision are ignored.
std::vector<LimitCheck> check_limits(const std::string& case_name,
                                     const std::vector<Expectation>& expectations,
                                     const std::vector<Verdict>& verdicts);

}  // namespace sandglass
