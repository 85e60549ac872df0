#pragma once

#include <string_view>

#include "element/operation_count.hpp"
#include "material/laws.hpp"

namespace sandglass {

/// Operations of one element and step of the method of that name with a law, by part, counted by running its
/// kernel. They do not depend on the law's parameters. Throws InputError when the method is unknown.
OperationCount operation_count(std::string_view method, const AnyLaw& law);

/// All of them.
Operations operations_of(std::string_view method, const AnyLaw& law);

}  // namespace sandglass
