#pragma once

#include "io/mesh_file.hpp"
#include "sandglass/simulation.hpp"

namespace sandglass {

/// Arrays of a program as a mesh with sets, each sorted. Throws InputError when a cell or set names a node
/// that the mesh has not, when a node belongs to no cell or stands nowhere, and when there are none.
MeshWithSets checked(MeshArrays arrays);

}  // namespace sandglass
