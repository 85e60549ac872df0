#pragma once

#include <filesystem>

#include "io/hdf5_file.hpp"
#include "mesh/mesh_with_sets.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// Writes mesh, sets and hashes of a scene: /mesh/points, /mesh/cells, /mesh/sets/NAME,
/// /mesh/element_sets/NAME, the ties of hanging nodes, /mesh/ties/node, of, weight, and, if there are several
/// materials, each element's number, /mesh/materials. Throws InputError.
void write_mesh_file(const Scene& scene, const std::filesystem::path& path);

/// The same, into an open file.
void write_mesh(const Scene& scene, Hdf5File& file);

/// Reads /mesh of a file. Throws InputError if it is not a mesh of hexahedra (shape, node numbers).
MeshWithSets read_mesh_file(const std::filesystem::path& path);

/// A nodal field of a file, one row per node. Throws InputError if it has another shape or a value is not
/// finite.
NodalField read_nodal_field(const Hdf5File& file, const std::string& name, std::size_t n_nodes);

}  // namespace sandglass
