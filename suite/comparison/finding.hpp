#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "base/error.hpp"
#include "comparison/accuracy.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// What became of a run, in the words of the failure map.
enum class Finding {
  good,          ///< as near the golden as the limit asks
  not_judged,    ///< farther, but no farther than the golden is from the truth: too far to judge by it
  inaccurate,    ///< farther, in none of the ways below
  hourglassing,  ///< farther, because nodes zigzag
  locking,       ///< farther, because the elements are too stiff
  inverted,      ///< an element turned inside out
  unstable,      ///< displacements grew until they were no numbers
  not_at_rest    ///< no balance of forces was found
};

/// All of them, from the best to the worst.
inline constexpr std::array all_findings{Finding::good,         Finding::not_judged, Finding::inaccurate,
                                         Finding::hourglassing, Finding::locking,    Finding::inverted,
                                         Finding::unstable,     Finding::not_at_rest};

/// The word for a finding: "good", "not at rest", ...
std::string_view name_of(Finding finding);

/// The finding that a computation which broke down leaves.
Finding finding_of(Breakdown breakdown);

/// What tells the ways to be wrong from each other.
struct Symptoms {
  double error = 0.0;          ///< max over all nodes of the distance from the golden, over the unit
  double zigzag_share = 0.0;   ///< share of the squared error that stands in hourglass modes
  double bending_ratio = 1.0;  ///< hourglass amplitudes over those of the golden
  /// Strain energy over that of the golden's element at the golden; the inverse where loads move the body,
  /// for there the stiffer one stores less.
  double stiffness_ratio = 1.0;
};

/// Hourglass amplitudes and displacements of a field, root mean squares over the volume (m): of gamma^T u and
/// of u. Linear fields have none of the first.
struct HourglassContent {
  double hourglass;
  double total;
};
HourglassContent hourglass_content(const Mesh& mesh, const NodalField& u);

/// The symptoms of displacements u (m) with strain and hourglass energy `energy` (J) compared with the
/// golden; `unit` is the length that errors are fractions of.
Symptoms symptoms(const Scene& scene, const NodalField& u, double energy, const NodalField& golden,
                  double unit);

/// The same of an answer at several times: at the worst of them. In motion the energy is that of another
/// state than the golden's, so that locking is not told.
Symptoms symptoms(const Scene& scene, const Displacements& u, double energy, const Displacements& golden,
                  double unit);

/// No run with a larger error is good, whatever the golden is worth.
inline constexpr double largest_good_limit = 0.1;

/// Error up to which a run is good: 1 %, or the golden's own distance from the truth where that is more,
/// because nearer to the golden is not nearer to the truth; at most `largest_good_limit`.
double good_limit(const std::optional<double>& golden_to_truth);

/// Good up to `limit`. Beyond it hourglassing when the hourglass amplitudes are 1.5 times the golden's or
/// more and a tenth of the squared error or more stands in them; locking when the body takes 3 % more energy
/// to deform than the golden, or more, and bends at most 1.2 times as much; else inaccurate.
Finding diagnose(const Symptoms& symptoms, double limit);

/// The finding of a run that is compared with a stored golden, whose own distance from the truth is given
/// where it is known. Where that is more than `largest_good_limit`, the golden cannot judge a run that is
/// farther from it than this limit but nearer than the truth: such a run may be better than the golden or
/// worse.
Finding judge(const Symptoms& symptoms, const std::optional<double>& golden_to_truth);

}  // namespace sandglass
