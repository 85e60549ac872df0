#pragma once

#include <string>

#include "io/toml.hpp"

namespace sandglass {

/// A document as text: tables and keys in the order of the file they were read from, those without one at the
/// end; numbers with as many digits as they need. Comments are not part of a document.
std::string toml_text(const toml::table& document);

/// A value on one line, as a case file may hold it, with as many digits as a number needs. toml++'s own text
/// of a list counts the columns of small numbers by an undefined conversion.
std::string value_text(const toml::node& value);

}  // namespace sandglass
