#pragma once

#include <string>

#include "choice/choose.hpp"

namespace sandglass {

/// What `choose` found, for people, in lines of at most 100 columns: meshes, those rungs that suffice with
/// the chosen one marked, remarks, and how many were rejected why. If all were tried, all are shown.
std::string choose_table(const Scene& scene, const Choice& choice);

}  // namespace sandglass
