#pragma once

#include <string_view>

#include "material/laws.hpp"
#include "math/counted.hpp"

namespace sandglass {

/// Operations of one element and step of the method of that name with a law, counted by running its kernel.
/// Throws InputError when the method is unknown.
Operations operations_of(std::string_view method, const AnyLaw& law);

}  // namespace sandglass
