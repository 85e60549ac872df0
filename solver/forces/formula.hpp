#pragma once

#include <functional>
#include <string>

namespace sandglass {

/// What a formula may have, in words.
std::string formula_language();

/// The value of a formula of the time t, such as "sin(2*pi*t/0.3)". Throws InputError that names what is
/// wrong, its position from 1, and what is allowed; so does the result where it is not finite. It may be
/// called by several threads.
std::function<double(double)> parse_formula(const std::string& text);

/// A formula and what it means; without a text there is none.
struct Formula {
  std::string text = {};
  std::function<double(double)> evaluate = {};

  Formula() = default;
  /// Throws as parse_formula does.
  explicit Formula(const std::string& written) : text(written), evaluate(parse_formula(written)) {}
};

}  // namespace sandglass
