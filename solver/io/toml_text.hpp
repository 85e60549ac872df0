#pragma once

#include <string>

#include "io/toml.hpp"

namespace sandglass {

/// A document as text: tables and keys in the order of the file from which they were read, new ones at the
/// end; numbers with as many digits as they need. Comments are not part of a document.
std::string toml_text(const toml::table& document);

/// A value on one line of a case file; numbers have as many digits as they need. (toml++ itself has undefined
/// behaviour when it formats lists of small numbers.)
std::string value_text(const toml::node& value);

}  // namespace sandglass
