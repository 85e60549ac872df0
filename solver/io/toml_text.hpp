#pragma once

#include <string>

#include "io/toml.hpp"

namespace sandglass {

/// A document as text: tables and keys in the order of the file they were read from, those without one at the
/// end; numbers with as many digits as they need. Comments are not part of a document.
std::string toml_text(const toml::table& document);

}  // namespace sandglass
