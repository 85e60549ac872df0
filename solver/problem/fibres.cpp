#include "problem/fibres.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace sandglass {

namespace {

/// The unit vector of a direction, without overflow. Throws InputError for zero.
Triple<double> unit(const Triple<double>& direction, std::string_view what) {
  const auto& [x, y, z] = direction.entries;
  const double length = std::hypot(x, y, z);
  if (!(length > 0.0 && std::isfinite(length))) {
    throw InputError(
        fmt::format("the direction of the {} is [{}, {}, {}]; its length must not be zero", what, x, y, z));
  }
  return (1.0 / length) * direction;
}

/// The part of a direction perpendicular to a unit vector.
Triple<double> across(const Triple<double>& direction, const Triple<double>& unit) {
  return direction - double_dot(direction, unit) * unit;
}

/// The coordinate axis that is most nearly perpendicular to a unit vector.
Triple<double> most_nearly_across(const Triple<double>& unit) {
  const auto smallest = std::min_element(unit.entries.begin(), unit.entries.end(),
                                         [](double a, double b) { return std::abs(a) < std::abs(b); });
  Triple<double> axis{};
  axis.entries[static_cast<std::size_t>(smallest - unit.entries.begin())] = 1.0;
  return axis;
}

MaterialAxes<double> helical_axes(const HelicalFibres& helix, const Vector& place) {
  Triple<double> axis{};
  axis(helix.axis, 0) = 1.0;
  const Triple<double> outward = across(Triple<double>{place} - Triple<double>{helix.center}, axis);
  const double r = std::sqrt(double_dot(outward, outward));
  const Triple<double> radial = unit(outward, "radius from the axis of the fibres");
  const double share = std::clamp((r - helix.radii[0]) / (helix.radii[1] - helix.radii[0]), 0.0, 1.0);
  const double angle = helix.angles[0] + share * (helix.angles[1] - helix.angles[0]);
  const Triple<double> fibre = std::cos(angle) * cross(axis, radial) + std::sin(angle) * axis;
  return axes_along(fibre.entries, radial.entries);
}

}  // namespace

MaterialAxes<double> axes_along(const Vector& fibre, const std::optional<Vector>& sheet) {
  const Triple<double> f = unit({fibre}, "fibres");
  const Triple<double> hint = sheet ? unit({*sheet}, "sheets") : most_nearly_across(f);
  const Triple<double> rest = across(hint, f);
  if (!(double_dot(rest, rest) > 1e-12)) throw InputError("sheets and fibres have the same direction");
  const Triple<double> s = unit(across(unit(rest, "sheets"), f), "sheets");  // twice is enough
  const Triple<double> n = cross(f, s);
  MaterialAxes<double> axes;
  for (int i = 0; i < 3; ++i) {
    axes(0, i) = f(i, 0);
    axes(1, i) = s(i, 0);
    axes(2, i) = n(i, 0);
  }
  return axes;
}

MaterialAxes<double> axes_by(const FibreRule& rule, const Mesh& mesh, std::size_t element) {
  if (const auto* uniform = std::get_if<UniformFibres>(&rule)) {
    return axes_along(uniform->fibre, uniform->sheet);
  }
  if (const auto* helix = std::get_if<HelicalFibres>(&rule)) {
    return helical_axes(*helix, mean_at(mesh.cells[element], mesh.points));
  }
  if (const auto* listed = std::get_if<ListedFibres>(&rule)) {
    if (listed->sheets.empty()) return axes_along(listed->fibres[element]);
    return axes_along(listed->fibres[element], listed->sheets[element]);
  }
  return identity<double>();
}

}  // namespace sandglass
