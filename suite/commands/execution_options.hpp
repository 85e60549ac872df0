#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "assembly/internal_force.hpp"
#include "base/error.hpp"
#include "base/names.hpp"

namespace sandglass {

/// The value of --precision. Throws InputError for anything but "double" and "float".
inline Precision parse_precision(const std::string& text) {
  if (text == "double") return Precision::double_precision;
  if (text == "float") return Precision::single_precision;
  throw InputError(fmt::format("--precision = '{}' must be 'double' or 'float'", text));
}

/// A positive number, and the unit after it.
struct Quantity {
  double value;
  std::string unit;
};

inline std::optional<Quantity> parse_quantity(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !(value > 0.0) || !std::isfinite(value)) return std::nullopt;
  return Quantity{value, std::string(end, text.data() + text.size())};
}

/// The value of an option that takes a share. Throws InputError for anything else.
inline double parse_share(const char* option, const std::string& text) {
  const auto quantity = parse_quantity(text);
  if (quantity && (quantity->unit.empty() || quantity->unit == "%")) {
    const double share = quantity->unit.empty() ? quantity->value : quantity->value / 100.0;
    if (share == 1.0 && quantity->unit.empty()) {
      throw InputError(
          fmt::format("{} = '{}' is ambiguous; for one percent write 1%, for everything 100%", option, text));
    }
    if (share <= 1.0) return share;
  }
  throw InputError(
      fmt::format("{} = '{}' must be a share in (0, 1], such as 0.01, or in percent, such as 1%{}", option,
                  text, decimal_comma_hint(text)));
}

/// The value of an option that takes a time, in seconds. Throws InputError for anything else.
inline double parse_time(const char* option, const std::string& text) {
  if (const auto quantity = parse_quantity(text)) {
    for (const auto& [unit, seconds] : {std::pair{"", 1.0}, {"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}}) {
      if (quantity->unit == unit) return quantity->value * seconds;
    }
  }
  throw InputError(fmt::format(
      "{} = '{}' must be a positive time in s, ms or us, such as 1ms; without a unit it is in s{}", option,
      text, decimal_comma_hint(text)));
}

/// Throws InputError unless `value`, given by `option`, lies in [1, most].
inline void require_count(const char* option, int value, int most) {
  if (value >= 1 && value <= most) return;
  throw InputError(fmt::format("{} = {} must be in [1, {}]", option, value, most));
}

/// More threads than this count as a typing error.
inline void require_threads(int threads) {
  require_count("--threads", threads, 1024);
}

}  // namespace sandglass
