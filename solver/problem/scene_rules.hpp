#pragma once

#include "problem/case.hpp"
#include "problem/scene.hpp"

/// The rules of a case that `make_scene` applies to a scene, one after another.
namespace sandglass {

/// The materials on a scene that has its mesh and element sets: each element with one, and its axes where a
/// material has fibres. Throws InputError for an element that has none or two, for a set that is not there or
/// empty, and for fibres without a direction or for another number of elements.
Materials make_materials(const Case& description, const Scene& scene);

/// Refines the mesh of a scene, which has its sets, boundary and materials: sets and materials pass on to the
/// parts of elements, and nodes that hang are tied. Throws InputError for a set that is not there, is empty,
/// or has no edge.
void refine(const Case& description, Scene& scene);

/// Ties the nodes of sets to the elements of sets: each node that is not a corner of the elements follows the
/// corners of the one that it is in, by the values of their shape functions there. Throws InputError for a
/// node that is in none of them, is tied twice or driven as well, and for a case that refines its mesh.
void tie(const Case& description, Scene& scene);

}  // namespace sandglass
