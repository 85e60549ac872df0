#pragma once

#include "problem/make_scene.hpp"

namespace sandglass {

/// Ties the nodes of sets to the elements of sets, as a case wants it: each node that is not a
/// corner of the elements follows the corners of the one that it is in, by the values of their shape
/// functions there. Throws InputError for a node that is in none of them, is tied twice or driven as well,
/// and for a case that refines its mesh.
void tie(const Case& description, Scene& scene);

}  // namespace sandglass
