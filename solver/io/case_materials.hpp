#pragma once

#include <vector>

#include "io/table_reader.hpp"
#include "problem/case.hpp"

namespace sandglass {

/// The materials of a case: [material], or several [[materials]]. Throws InputError that names file, key,
/// value and rule.
std::vector<CaseMaterial> read_materials(TableReader& reader);

}  // namespace sandglass
