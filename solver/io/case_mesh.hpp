#pragma once

#include "io/table_reader.hpp"
#include "problem/case.hpp"

namespace sandglass {

/// The source of a mesh: the table [mesh], whose file is relative to a folder. Throws InputError that names
/// file, key, value and rule.
MeshSource read_mesh_source(TableReader& table, const std::filesystem::path& folder);

}  // namespace sandglass
