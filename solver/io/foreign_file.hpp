#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/mesh_file.hpp"
#include "problem/case.hpp"

namespace sandglass {

// Files of other programs are converted by exchange/convert.py in a separate process, because the libraries
// for these formats are in Python. Its warnings go to standard error.

/// Whether a mesh file, by its ending, is from another program, .msh (Gmsh), .inp (Abaqus, CalculiX) or .vtu
/// (VTK), or a labelled image, .npy (NumPy), .nii or .nii.gz (NIfTI).
bool is_foreign_mesh(const std::filesystem::path& path);

/// The mesh and sets of such a file, with hexahedra in VTK order. Throws InputError if it is not a mesh of
/// hexahedra or a package is missing.
MeshWithSets read_foreign_mesh(const MeshFile& file);

/// Runs exchange/convert.py with arguments; `path` is the user's file, for messages. Throws InputError with
/// its message about wrong input, or ComputationError if it fails.
void run_converter(std::vector<std::string> arguments, const std::filesystem::path& path);

/// A user's path as an argument that cannot be taken for an option.
std::string as_argument(const std::filesystem::path& path);

}  // namespace sandglass
