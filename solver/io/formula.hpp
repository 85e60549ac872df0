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

}  // namespace sandglass
