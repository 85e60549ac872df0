#pragma once

#include <fmt/format.h>

#include <string>

#include "base/error.hpp"
#include "model/internal_force.hpp"

namespace sandglass {

/// The value of --precision. Throws InputError for anything but "double" and "float".
inline Precision parse_precision(const std::string& text) {
  if (text == "double") return Precision::double_precision;
  if (text == "float") return Precision::single_precision;
  throw InputError(fmt::format("--precision = '{}' must be 'double' or 'float'", text));
}

/// Throws InputError unless `value`, given by `option`, lies in [1, most].
inline void require_count(const char* option, int value, int most) {
  if (value >= 1 && value <= most) return;
  throw InputError(fmt::format("{} = {} must be in [1, {}]", option, value, most));
}

/// More threads than any machine has processors are a slip.
inline void require_threads(int threads) {
  require_count("--threads", threads, 1024);
}

}  // namespace sandglass
