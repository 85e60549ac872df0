#pragma once

#include "problem/case.hpp"
#include "problem/scene.hpp"

/// The rules of a case that `make_scene` applies to a scene, one after another.
namespace sandglass {

/// Assigns materials in a scene with mesh and element sets: one to each element, and axes if the material has
/// fibres. Throws InputError for an element with none or two, for a missing or empty set, and for fibres
/// without a direction or for another number of elements.
Materials make_materials(const Case& description, const Scene& scene);

/// Refines the mesh of a scene with sets, boundary and materials: parts of elements inherit sets and
/// materials, and hanging nodes are tied. Throws InputError for a set that is missing, empty or without an
/// edge.
void refine(const Case& description, Scene& scene);

/// Ties the nodes of sets to the elements of sets: each node that is not a corner of the elements follows the
/// corners of the element around it, weighted by their shape functions there. Throws InputError for a node
/// that is outside the elements, tied twice or also driven, and for a case that refines its mesh.
void tie(const Case& description, Scene& scene);

/// Young's modulus of each element's undeformed material, Pa.
std::vector<double> young_moduli(const Mesh& mesh, const Materials& materials);

}  // namespace sandglass
