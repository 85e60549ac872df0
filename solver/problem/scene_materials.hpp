#pragma once

#include "problem/make_scene.hpp"

namespace sandglass {

/// The materials of a case on a scene that has its mesh and element sets: each element with one, and its
/// axes where a material has fibres. Throws InputError for an element that has none or two, for a set that is
/// not there or empty, and for fibres without a direction or for another number of elements.
Materials make_materials(const Case& description, const Scene& scene);

}  // namespace sandglass
