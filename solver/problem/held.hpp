#pragma once

#include <string>

#include "mesh/free_motions.hpp"
#include "problem/scene.hpp"

namespace sandglass {

/// The rigid motions against which neither constraints nor forces hold a body.
std::vector<LooseBody> free_motions(const Scene& scene);

/// What nothing holds, in words: for each piece of the body how many elements and where, its free motions,
/// and nodes that would hold it; empty if all is held. At most three pieces are named.
std::string described_free_motions(const Scene& scene);

/// Throws InputError with these words for a scene that is to be at rest, if anything is free.
void require_held(const Scene& scene);

}  // namespace sandglass
