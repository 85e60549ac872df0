#pragma once

#include <string>

#include "choice/choose.hpp"
#include "io/result_file.hpp"

namespace sandglass {

/// A choice as JSON text: provenance, the demand, the reference, coarser meshes, and one record for each
/// candidate in the order of cost. Unknown values are null. "chosen" is an index into the records; null:
/// nothing suffices.
std::string to_json(const Provenance& provenance, const Scene& scene, const Choice& choice);

}  // namespace sandglass
