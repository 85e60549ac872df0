#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

/// Texts of case files.
namespace sandglass::verification {

/// A quasi-static case of a box of soft tissue, up to its material; tests add sets and loads. `size` (m) and
/// `elements` are as in the file: "[1.0, 2.0, 3.0]".
inline std::string box_case(const std::string& name, const std::string& size, const std::string& elements) {
  return fmt::format(R"([case]
name = "{}"
requirement = "A block is pulled."
answer = "quasi-static"

[mesh]
generator = "box"
size = {}
elements = {}

[material]
law = "neo-hookean"
young_modulus = 3000.0
poisson_ratio = 0.49
density = 1000.0

)",
                     name, size, elements);
}

/// The text with the first occurrence of `old` replaced, which must exist.
inline std::string replaced(std::string text, const std::string& old, const std::string& replacement) {
  const auto at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("not in the text: " + old);
  return text.replace(at, old.size(), replacement);
}

}  // namespace sandglass::verification
