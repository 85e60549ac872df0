#pragma once

#include <string>

#include "choice/choose.hpp"

namespace sandglass {

/// The result of `choose` as text of at most 100 columns: meshes, the sufficient candidates with the chosen
/// one marked, remarks, and how many were rejected for which reason. If all were tried, all are shown.
std::string choose_table(const Scene& scene, const Choice& choice);

}  // namespace sandglass
