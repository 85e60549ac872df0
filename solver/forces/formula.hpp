#pragma once

#include <functional>
#include <string>

namespace sandglass {

/// The language of formulas, as text for messages.
std::string formula_language();

/// The value of a formula of the time t, such as "sin(2*pi*t/0.3)". Throws InputError with the mistake, its
/// position counted from 1, and what is allowed. The function throws if its value is not finite; several
/// threads may call it. Messages begin with `name`, such as the place in a file.
std::function<double(double)> parse_formula(const std::string& text, const std::string& name = "formula");

/// A formula as text and as a function; no formula if the text is empty.
struct Formula {
  std::string text = {};
  std::function<double(double)> evaluate = {};

  Formula() = default;
  /// Throws like parse_formula.
  explicit Formula(const std::string& written, const std::string& name = "formula")
      : text(written), evaluate(parse_formula(written, name)) {}
};

}  // namespace sandglass
