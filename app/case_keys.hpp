#pragma once

#include <string>

namespace sandglass {

/// Every key that a case file may have, with type, unit, range, default and meaning, for people.
std::string describe_case_keys();

}  // namespace sandglass
