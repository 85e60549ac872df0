#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sandglass {

/// The known name nearest to `name` in edit distance, or "" when none is near enough for `name` to be a typo.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

/// The sentence "did you mean 'x'? known: a, b, c" that ends an error about an unknown name.
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

}  // namespace sandglass
