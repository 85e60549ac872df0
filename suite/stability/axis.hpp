#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.hpp"
#include "stability/trial.hpp"

namespace sandglass {

/// Something that a map varies.
struct Axis {
  std::string_view name;
  Range range;
  std::string_view meaning;
  std::vector<double> values;                 ///< those of a map that asks for no others
  bool whole_numbers = false;                 ///< whether only these make sense
  void (*apply)(Trial& trial, double value);  ///< gives the trial this value
  bool (*possible)(const Case&) = [](const Case&) { return true; };  ///< whether a case can be varied so
  std::string_view needs = {};                                       ///< what those have that can
  bool (*matters)(const Trial&) = [](const Trial&) {
    return true;
  };  ///< whether it matters to a trial's method
};

/// THE list of axes. A new one is an entry.
std::span<const Axis> axes();

/// The axis of that name. Throws InputError that suggests a known one.
const Axis& find_axis(std::string_view name);

/// Two axes and their values, y upwards; or one, when y has no axis.
struct Map {
  const Axis* x = nullptr;
  const Axis* y = nullptr;
  std::vector<double> xs;
  std::vector<double> ys{0.0};

  /// "load-nu", or "load".
  std::string name() const;
};

/// The map of "X,Y" or "X", with the axes' own values. Throws InputError.
Map parse_map(const std::string& text);

/// The maps of a case when none is requested: all that are possible with it.
std::vector<Map> usual_maps(const Case& description);

/// Replaces the values of an axis in all maps by "AXIS=V1,V2,...". Throws InputError for a value out of
/// range, and where no map has that axis.
void set_values(const std::string& text, std::vector<Map>& maps);

/// Throws InputError when the case cannot be varied along the axes of the map.
void require_possible(const Map& map, const Case& description);

/// A trial of the map.
Trial trial_of(const Map& map, const Case& description, const std::string& method, double x, double y);

/// Whether the map says anything about the method: one without kappa has no map over kappa, and a condensed
/// one no dynamics.
bool concerns(const Map& map, const Case& description, const std::string& method);

}  // namespace sandglass
