#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.hpp"
#include "stability/trial.hpp"

namespace sandglass {

/// A property that a map varies.
struct Axis {
  std::string_view name;
  Range range;
  std::string_view meaning;
  std::vector<double> values;                 ///< by default
  bool whole_numbers = false;                 ///< whether values must be whole numbers
  void (*apply)(Trial& trial, double value);  ///< gives the trial this value
  bool (*possible)(const Case&) = [](const Case&) {
    return true;
  };                            ///< whether a case can be varied along this axis
  std::string_view needs = {};  ///< the condition for that
  bool (*matters)(const Trial&) = [](const Trial&) {
    return true;
  };  ///< whether it matters to a trial's method
};

/// THE list of axes. A new axis is one entry.
std::span<const Axis> axes();

/// The axis of that name. Throws InputError that suggests a known one.
const Axis& find_axis(std::string_view name);

/// One or two axes and their values; y points upwards.
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

/// The default maps of a case: all that are possible with it.
std::vector<Map> usual_maps(const Case& description);

/// Replaces the values of an axis in all maps by "AXIS=V1,V2,...". Throws InputError for a value out of
/// range, or if no map has that axis.
void set_values(const std::string& text, std::vector<Map>& maps);

/// Throws InputError if the case cannot be varied along the axes of the map.
void require_possible(const Map& map, const Case& description);

/// A trial of the map.
Trial trial_of(const Map& map, const Case& description, const std::string& method, double x, double y);

/// Whether the map applies to the method: a method without kappa has no map over kappa, and a condensed
/// method has no dynamics.
bool concerns(const Map& map, const Case& description, const std::string& method);

}  // namespace sandglass
