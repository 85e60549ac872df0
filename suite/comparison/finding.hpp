#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "base/error.hpp"
#include "comparison/accuracy.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// The outcome of a run, as in the failure maps.
enum class Finding {
  good,           ///< within the limit from the golden
  not_judged,     ///< farther, but closer than the truth is: such a golden cannot judge
  inaccurate,     ///< farther, for none of the reasons below
  hourglassing,   ///< farther, because nodes zigzag
  locking,        ///< farther, because the elements are too stiff
  inverted,       ///< an element turned inside out
  unstable,       ///< displacements grew until they were not finite
  no_equilibrium  ///< no static equilibrium was found
};

/// All of them, from the best to the worst.
inline constexpr std::array all_findings{Finding::good,         Finding::not_judged,    Finding::inaccurate,
                                         Finding::hourglassing, Finding::locking,       Finding::inverted,
                                         Finding::unstable,     Finding::no_equilibrium};

/// The word for a finding: "good", "not at rest", ...
std::string_view name_of(Finding finding);

/// The finding for a computation that broke down.
Finding finding_of(Breakdown breakdown);

/// The figures that distinguish the kinds of failure.
struct Symptoms {
  double error = 0.0;          ///< max over all nodes of the distance from the golden, over the unit
  double zigzag_share = 0.0;   ///< share of the squared error in hourglass modes
  double bending_ratio = 1.0;  ///< hourglass amplitudes over those of the golden
  /// Strain energy over that of the golden's element at the golden; the inverse if loads move the body,
  /// because then the stiffer body stores less.
  double stiffness_ratio = 1.0;
};

/// Root mean squares over the volume (m) of a field's hourglass amplitudes gamma^T u, which are zero for
/// linear fields, and of its displacements u.
struct HourglassContent {
  double hourglass;
  double total;
};
HourglassContent hourglass_content(const Mesh& mesh, const NodalField& u);

/// The symptoms of displacements u (m) with strain and hourglass energy `energy` (J), compared with the
/// golden; errors are fractions of `unit` (m).
Symptoms symptoms(const Scene& scene, const NodalField& u, double energy, const NodalField& golden,
                  double unit);

/// The same for an answer at several times: the symptoms at the worst of them. In motion the energy belongs
/// to another state than the golden's, so locking is not detected.
Symptoms symptoms(const Scene& scene, const Displacements& u, double energy, const Displacements& golden,
                  double unit);

/// No run with a larger error is good, however inaccurate the golden is.
inline constexpr double largest_good_limit = 0.1;

/// The largest error of a good run: 1 %, or the golden's own distance from the truth if that is larger,
/// because closer to the golden is not closer to the truth; at most `largest_good_limit`.
double good_limit(const std::optional<double>& golden_to_truth);

/// Good up to `limit`. Beyond it: hourglassing if the hourglass amplitudes are at least 1.5 times the
/// golden's and hold at least a tenth of the squared error; locking if deforming the body takes at least 3 %
/// more energy than the golden and it bends at most 1.2 times as much; else inaccurate.
Finding diagnose(const Symptoms& symptoms, double limit);

/// The finding of a run compared with a stored golden, whose own distance from the truth is given if known.
/// If that is more than `largest_good_limit`, the golden cannot judge a run that is farther from it than this
/// limit but closer than the truth: such a run may be better or worse than the golden.
Finding judge(const Symptoms& symptoms, const std::optional<double>& golden_to_truth);

}  // namespace sandglass
