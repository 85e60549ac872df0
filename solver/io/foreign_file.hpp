#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/mesh_file.hpp"
#include "problem/case.hpp"

namespace sandglass {

// Files of other programs are converted by exchange/convert.py, a process of its own: the libraries that know
// these formats are Python's. Its warnings go to standard error.

/// Whether the ending of a mesh's file is that of another program: .msh (Gmsh), .inp (Abaqus, CalculiX),
/// .vtu (VTK), or of a labelled image: .npy (NumPy), .nii, .nii.gz (NIfTI).
bool is_foreign_mesh(const std::filesystem::path& path);

/// The mesh of such a file, its hexahedra numbered as VTK does it, with its sets. Throws InputError when it
/// is no mesh of hexahedra and where a package is missing.
MeshWithSets read_foreign_mesh(const MeshFile& file);

/// Runs exchange/convert.py with arguments; `path` is the user's file, for messages. Throws InputError with
/// what it says of wrong input, ComputationError when it fails.
void run_converter(std::vector<std::string> arguments, const std::filesystem::path& path);

/// A path of the user as an argument that is no option.
std::string as_argument(const std::filesystem::path& path);

}  // namespace sandglass
