#pragma once

#include "support/case_text.hpp"

/// A case file without mistakes, of which tests change parts.
namespace sandglass::verification::good_case {

inline const std::string good = box_case("good", "[1.0, 2.0, 3.0]", "[1, 2, 3]") + R"([sets]
bottom = { z = [0.0, 0.0] }
top = { z = [3.0, 3.0] }

[[displacement]]
set = "bottom"
value = [0.0, 0.0, 0.0]

[[displacement]]
set = "top"
value = [0.5, 0.0, 0.3]
components = "xz"

[profile]
set = "top"
order = "x"

[relaxation]
tolerance = 1e-7

[comparison]
kappas = [0.01, 0.02]

[[expect]]
method = "tl-perturbation"
kappa = 0.01
reference = "golden"
figure = "rms_relative_error"
below = 0.01
reason = "a test"
)";

/// Its mesh.
inline const std::string own_mesh = "generator = \"box\"\nsize = [1.0, 2.0, 3.0]\nelements = [1, 2, 3]";

/// `good` with the first occurrence of `old` replaced, which must exist.
inline std::string with(const std::string& old, const std::string& replacement) {
  return replaced(good, old, replacement);
}

/// Two boxes in place of the box of `good`.
inline const std::string two_boxes = R"([[mesh.bodies]]
name = "one"
generator = "box"
size = [1.0, 2.0, 3.0]
elements = [1, 2, 3]

[[mesh.bodies]]
name = "two"
offset = [0.0, 0.0, 3.0]
generator = "box"
size = [1.0, 2.0, 3.0]
elements = [1, 1, 1]
)";

/// `good` with these boxes.
inline const std::string two_bodies = with("[mesh]\n" + own_mesh + "\n", two_boxes);

}  // namespace sandglass::verification::good_case
