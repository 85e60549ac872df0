#pragma once

#include <fmt/format.h>

#include <limits>
#include <string>
#include <string_view>
#include <tuple>

namespace sandglass {

/// An interval of allowed values, each end open or closed.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = true;
  bool high_open = true;

  /// Whether `value` lies in the interval; NaN does not.
  constexpr bool contains(double value) const {
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
  }

  /// The interval in the usual notation: "(0, 0.5)", "[1, inf)".
  std::string text() const {
    return fmt::format("{}{}, {}{}", low_open ? '(' : '[', low, high, high_open ? ')' : ']');
  }

  static constexpr Range positive() { return {.low = 0.0}; }
  static constexpr Range at_least(double low) { return {.low = low, .low_open = false}; }
  static constexpr Range between(double low, double high) { return {.low = low, .high = high}; }
  static constexpr Range any() { return {}; }
};

/// The declaration of one parameter: its member, name, unit, range and meaning. The reader of case files, the
/// help texts and the tests all iterate these declarations; nothing is declared twice. An `Owner` returns a
/// tuple of its declarations from a static function `parameters()`.
template <class Owner, class Value>
struct Parameter {
  Value Owner::*member;
  std::string_view name;
  std::string_view unit;
  Range range;
  std::string_view meaning;
  bool required = true;  ///< if false, the member's initial value is the default
};

// Clang up to 16 does not deduce the template arguments of an aggregate.
template <class Owner, class Value>
Parameter(Value Owner::*, std::string_view, std::string_view, Range, std::string_view, bool = true)
    -> Parameter<Owner, Value>;

/// A broken rule that no range can express, because it involves several parameters. An `Owner` with such
/// rules has a function `std::optional<BrokenRule> broken_rule() const`, which the reader of case files
/// calls.
struct BrokenRule {
  std::string parameter;  ///< to which the message refers
  std::string message;    ///< the text after its name: value, rule, what is allowed
};

/// The declarations of a base class, for a class derived from it.
template <class Derived, class Parameters>
constexpr auto inherited_parameters(const Parameters& parameters) {
  const auto inherited = []<class Owner, class Value>(const Parameter<Owner, Value>& p) {
    return Parameter<Derived, Value>{p.member, p.name, p.unit, p.range, p.meaning, p.required};
  };
  return std::apply([&](const auto&... p) { return std::tuple{inherited(p)...}; }, parameters);
}

}  // namespace sandglass
