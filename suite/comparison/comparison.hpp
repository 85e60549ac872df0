#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "problem/scene.hpp"

namespace sandglass {

/// The method of the golden's element: eight points and one pressure. Every other method is compared with it.
inline constexpr std::string_view golden_method = "tl-mean-dilatation";

/// The values of another program on one or several meshes.
struct ProgramValues {
  std::string program;         ///< program and element
  std::vector<int> elements;   ///< per side of the mesh of each value, as variants are named; empty: unknown
  std::vector<double> values;  ///< m or rad
  std::string source;
};

/// What a value is of: the answer or, of a motion sampled at its frames, the first extremum or the time from
/// there to the next one on the same side.
enum class Feature { end, peak, period };
constexpr std::array<std::string_view, 3> words_of(Feature /*type*/) {
  return {"end", "peak", "period"};
}

/// A published motion of a node set, computed by other programs or measured, or a known force of obstacles.
struct PublishedValue {
  std::string set;        ///< of a force, the names of the obstacles
  std::string component;  ///< "x", "y", "z": mean displacement; "around-x", ...: mean rotation
  double value = 0.0;     ///< m or rad, of a period s, of a force N; not zero
  std::string source;     ///< where it was published
  std::vector<ProgramValues> programs = {};
  std::optional<double> scatter = {};  ///< of a measurement, in the unit of the value; else none
  std::optional<Vector> at = {};       ///< instead of the mean: a point that moves with the set, m
  Feature of = Feature::end;
  std::vector<std::string> obstacles = {};  ///< whose forces on the body add up to the value; empty: a motion
  double over = 0.0;  ///< s, at the end, over which a force is the mean of all checks; 0: at the last one
};

/// A line of nodes along which displacements are plotted and compared, as in the paper's figures 2 and 4.
struct Profile {
  std::string set;
  std::string
      order;  ///< "x", "y", "z" along an axis; "around-x", ... by angle about an axis through the centroid
};

/// A limit that `sandglass verify` checks for a method.
struct Expectation {
  std::string method;
  std::string kappa = "auto";   ///< a number, "auto", or "best": the smallest figure over the case's kappas
  std::string reference;        ///< "golden", "truth", "published" or "measured"
  std::string figure;           ///< "max_relative_error", "profile_relative_error" or "rms_relative_error";
                                ///< "relative_error" of published and measured values, without periods;
                                ///< "period_error" of measured periods
  std::optional<double> below;  ///< the figure must be at most this, fraction
  std::optional<double> above;  ///< the figure must be more than this: the method must fail visibly
  std::string reason;
};

/// The tables of a case file about answers and their limits, which the library does not read: [profile],
/// [comparison], [[published]], [[measured]] and [[expect]].
struct Comparison {
  std::optional<Profile> profile;
  std::vector<double> kappas;  ///< the curve that `sandglass verify` computes in addition to `auto`
  std::vector<Expectation> expectations;
  std::vector<PublishedValue> published;  ///< and measured
  std::filesystem::path golden;
  std::filesystem::path truth;
};

/// Reads the comparison of a case from its file, as strictly as the library reads the case; it is empty for a
/// case without a file. Throws InputError that names file, line, key, value and rule.
Comparison read_comparison(const CaseSettings& settings);

/// The same for the case of a scene, in which all named sets must exist.
Comparison read_comparison(const Scene& scene);

/// A description of the keys of these tables.
std::string describe_comparison_keys();

}  // namespace sandglass
