#pragma once

#include <filesystem>
#include <string>

#include "problem/scene.hpp"

namespace sandglass {

/// Writes mesh and sets of a scene in a format of other programs: "vtu", "xdmf" or "inp". Throws InputError
/// for a mesh with hanging nodes, which no such format supports.
void write_foreign_mesh(const Scene& scene, const std::filesystem::path& path, const std::string& format);

/// How the nodes of a file are matched.
struct NodeMatching {
  double tolerance =
      1e-5;  ///< nodes closer than this are the same; a fraction of the diagonal of the scene's nodes
  std::string field = {};  ///< name of the displacements in the file; empty: the usual names
};

/// Displacements (m) from a file of another program, or of ours, at the nodes of a scene; exchange/README.md
/// lists the formats. Throws InputError unless each node of the scene is found exactly once.
NodalField read_foreign_displacement(const std::filesystem::path& path, const Scene& scene,
                                     const NodeMatching& matching);

}  // namespace sandglass
