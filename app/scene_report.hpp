#pragma once

#include <string>

#include "problem/make_scene.hpp"

namespace sandglass {

/// Every set: how many nodes or elements, its extent, whether it is a volume, a face, an edge or points, and
/// whether a table uses it.
void print_sets(const Case& description, const Scene& scene);

/// Prints what was understood of a body, if it may surprise: parts that are not joined (elements, place,
/// mass), what nothing holds in motion, sets of a file that a rule replaces, sets that no table uses; and to
/// standard error warnings of probable mistakes: planes of nodes that a rule cuts, seams of nodes that are
/// not joined, units. Each line begins with `of`.
void print_understood(const CaseOnMesh& problem, const Scene& scene, const std::string& of = "");

/// A note on the free motions of a body, if it has any.
void print_free_motions(const Scene& scene, const std::string& of = "");

/// The scene of a case, for commands that compute with it: as above, with the case's name before each line.
/// Throws InputError for a body at rest that is not held.
Scene understood_scene(Case description);

}  // namespace sandglass
