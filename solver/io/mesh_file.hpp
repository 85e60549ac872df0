#pragma once

#include <filesystem>

#include "io/hdf5_file.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// Writes mesh, sets and hashes of a scene: /mesh/points, /mesh/cells, /mesh/sets/NAME,
/// /mesh/element_sets/NAME, the ties of nodes that hang, /mesh/ties/node, of, weight, and, where there are
/// several, the number of each element's material, /mesh/materials. Throws InputError.
void write_mesh_file(const Scene& scene, const std::filesystem::path& path);

/// The same into a file that is being written.
void write_mesh(const Scene& scene, Hdf5File& file);

/// A mesh and the sets that came with it.
struct MeshWithSets {
  Mesh mesh;
  NodeSets sets;
  ElementSets element_sets = {};
};

/// Reads /mesh of a file. Throws InputError when it is no mesh of hexahedra (shape, node numbers).
MeshWithSets read_mesh_file(const std::filesystem::path& path);

/// A nodal field of a file, one row per node. Throws InputError when it has another shape or a value is not
/// finite.
NodalField read_nodal_field(const Hdf5File& file, const std::string& name, std::size_t n_nodes);

}  // namespace sandglass
