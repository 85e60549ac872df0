#pragma once

#include <filesystem>
#include <string>

#include "commands/deck_file.hpp"

namespace sandglass {

/// A format of meshes: of a file, or of the complete input of another program.
struct MeshFormat {
  std::string format = {};  ///< "h5", "vtu", "xdmf" or "inp"; empty: as the file's extension says
  DeckOptions deck = {};    ///< with a program: its input instead
};

/// Writes mesh and node sets of a scene. Throws InputError for an unknown format, and for what it cannot
/// express.
void write_mesh_of(const Scene& scene, const std::filesystem::path& output, const MeshFormat& as);

}  // namespace sandglass
