#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace sandglass {

/// A quantity with an SI prefix, such as "3 kPa"; none for zero and beyond the largest prefixes.
inline std::string with_prefix(double value, std::string_view unit) {
  struct Prefix {
    double factor;
    const char* name;
  };
  constexpr std::array<Prefix, 7> prefixes{
      {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1.0, ""}, {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}}};
  const double rounding = 1.0 - 5e-4;  // 999.6 is printed as 1000
  for (const auto& [factor, name] : prefixes) {
    const double count = std::abs(value) / factor;
    if (count >= rounding && count < 1e3 * rounding)
      return fmt::format("{:.3g} {}{}", value / factor, name, unit);
  }
  return fmt::format("{:.3g} {}", value, unit);
}

/// A length (m) as text, in mm from a micrometre to a metre, else in m.
inline std::string length_text(double metres) {
  const bool small = std::abs(metres) < 0.9995 && std::abs(metres) >= 1e-6;
  return small ? fmt::format("{:.3g} mm", 1e3 * metres) : fmt::format("{:.3g} m", metres);
}

/// A mass (kg) as text, in g below a kilogram.
inline std::string mass_text(double mass) {
  return mass < 0.9995 ? with_prefix(1e3 * mass, "g") : fmt::format("{:.3g} kg", mass);
}

}  // namespace sandglass
