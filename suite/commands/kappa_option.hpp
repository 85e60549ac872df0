#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/names.hpp"
#include "element/hourglass_settings.hpp"

namespace sandglass {

/// The value of --kappa: a number, or none for "auto". Throws InputError for anything else.
inline std::optional<double> parse_kappa(const std::string& text) {
  if (text == "auto") return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= 0.0)) {
    throw InputError(fmt::format("--kappa = '{}' must be a number in [0, inf), or 'auto'{}", text,
                                 decimal_comma_hint(text)));
  }
  return value;
}

/// The value of --kappa-modulus. Throws InputError for anything but "p-wave" and "shear".
inline KappaModulus parse_kappa_modulus(const std::string& text) {
  if (text == "p-wave") return KappaModulus::p_wave;
  if (text == "shear") return KappaModulus::shear;
  throw InputError(fmt::format("--kappa-modulus = '{}' must be 'p-wave' or 'shear'", text));
}

}  // namespace sandglass
