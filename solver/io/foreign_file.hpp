#pragma once

#include <filesystem>
#include <string>

#include "io/mesh_file.hpp"

namespace sandglass {

// Files of other programs are converted by exchange/convert.py, a process of its own: the libraries that know
// these formats are Python's. Its warnings go to standard error.

/// Whether the ending of a mesh's file is that of another program: .msh (Gmsh), .inp (Abaqus, CalculiX),
/// .vtu (VTK), or of a labelled image: .npy (NumPy), .nii, .nii.gz (NIfTI).
bool is_foreign_mesh(const std::filesystem::path& path);

/// The mesh of such a file, its hexahedra numbered as VTK does it, with its sets. Throws InputError when it
/// is no mesh of hexahedra and where a package is missing.
MeshWithSets read_foreign_mesh(const MeshFile& file);

/// How a mesh is written for another program.
struct ForeignFormat {
  std::string name;              ///< "vtu", "xdmf" or "inp"
  bool deck = false;             ///< of "inp": with material, displacements and forces, for CalculiX
  std::string element = "C3D8";  ///< of "inp": the type of its bricks
};

/// Writes the mesh and node sets of a scene. Throws InputError where the format or CalculiX cannot say it.
void write_foreign_mesh(const Scene& scene, const std::filesystem::path& path, const ForeignFormat& format);

/// How nodes of a file are found.
struct NodeMatching {
  double tolerance = 1e-5;  ///< distance that is none, as a fraction of the diagonal of the scene's nodes
  std::string field = {};   ///< name of the displacements in the file; empty: the usual names
};

/// Displacements (m) of another program's answer, or of ours, at the nodes of a scene: .h5, .vtu, .csv, .frd.
/// Throws InputError unless each node of the scene is found once.
NodalField read_foreign_displacement(const std::filesystem::path& path, const Scene& scene,
                                     const NodeMatching& matching);

}  // namespace sandglass
