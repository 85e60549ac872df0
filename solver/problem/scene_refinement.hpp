#pragma once

#include "problem/scene.hpp"

namespace sandglass {

/// Refines the mesh of a scene, which has its sets, boundary and materials, as its case wants it: sets and
/// materials pass on to the parts of elements, and nodes that hang are tied. Throws InputError for a set that
/// is not there, is empty, or has no edge.
void refine(Scene& scene);

}  // namespace sandglass
