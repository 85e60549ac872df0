#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "base/error.hpp"

namespace sandglass {

/// The value of --kappa: a number, or none for "auto". Throws InputError for anything else.
inline std::optional<double> parse_kappa(const std::string& text) {
  if (text == "auto") return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= 0.0)) {
    throw InputError(fmt::format("--kappa = '{}' must be a number in [0, inf), or 'auto'", text));
  }
  return value;
}

}  // namespace sandglass
