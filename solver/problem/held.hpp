#pragma once

#include <string>

#include "mesh/free_motions.hpp"
#include "problem/scene.hpp"

namespace sandglass {

/// The rigid motions against which neither constraints nor forces hold a body.
std::vector<LooseBody> free_motions(const Scene& scene);

/// A description of the pieces that nothing holds, at most three: their elements, place and free motions;
/// empty if the whole body is held.
std::string described_free_motions(const Scene& scene);

/// Throws InputError if a piece of the body is free: with this description and nodes that would hold it.
void require_held(const Scene& scene);

}  // namespace sandglass
