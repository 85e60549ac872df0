#pragma once

#include "problem/case.hpp"
#include "problem/scene.hpp"

namespace sandglass {

/// The parts of a body that are not joined, if there are several: elements, place, mass.
void print_parts(const Scene& scene);

/// Every set: how many nodes or elements, its extent, whether it is a volume, a face, an edge or points, and
/// whether a table uses it.
void print_sets(const Case& description, const Scene& scene);

/// Prints warnings of probable mistakes to standard error: planes of nodes that a rule cuts, seams of nodes
/// that are not joined, units; and a note on sets that no table uses.
void warn_of_oddities(const Case& description, const Scene& scene);

/// The free motions of a scene's body, if there are any.
void print_free_motions(const Scene& scene);

}  // namespace sandglass
