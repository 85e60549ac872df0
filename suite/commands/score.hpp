#pragma once

#include <string>

#include "comparison/verdict.hpp"

namespace sandglass {

/// The verdict on displacements u (m) of any program at the nodes of a quasi-static scene, against its stored
/// references, and without a golden against the mean-dilatation element, computed here. `name` stands for the
/// method. Throws InputError for a dynamic case, and for fields of another length; ComputationError if that
/// element finds no answer.
Verdict score(const Scene& scene, const NodalField& u, const std::string& name);

/// Throws InputError for a dynamic case, which has no answer to score.
void require_scorable(const Scene& scene);

}  // namespace sandglass
