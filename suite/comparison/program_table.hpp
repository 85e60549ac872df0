#pragma once

#include <string>
#include <vector>

#include "comparison/verdict.hpp"

namespace sandglass {

/// The name of a method as a row of a table, with its kappa where that is not `auto`.
std::string row_label(const Verdict& verdict);

/// For people: a table for each published value of these verdicts, all of one case file, that lists other
/// programs: a row for each method and for each program, a column for each mesh of any of them. Meshes are
/// the variants on the last axis of the file, named after their elements per side; every combination of the
/// other axes has tables of its own.
std::string program_tables(const std::vector<const Verdict*>& family);

}  // namespace sandglass
