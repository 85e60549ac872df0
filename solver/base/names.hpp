#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sandglass {

/// The known name nearest to `name`, or "" if none is near enough for `name` to be a typo. Missing, added,
/// wrong and swapped letters count; dashes before a name do not count as letters.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// "; did you mean 'x'?", or "" if no known name is near enough.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

/// The sentence "did you mean 'x'? known: a, b, c" that ends an error about an unknown name; of many known
/// names the three nearest: "nearest of 20: a, b, c".
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

/// "; did you mean 0.49, with a decimal point?" for a number with a decimal comma, with or without a unit; ""
/// for any other text.
std::string decimal_comma_hint(std::string_view text);

}  // namespace sandglass
