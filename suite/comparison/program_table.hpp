#pragma once

#include <string>
#include <vector>

#include "comparison/verdict.hpp"

namespace sandglass {

/// The width of the first column of tables, which names their rows.
constexpr std::size_t label_width = 32;

/// The name of a method as a row of a table, with its kappa unless that is `auto`.
std::string row_label(const Verdict& verdict);

/// As text: a table for each published value of these verdicts (of one case file) that lists other programs,
/// with a row for each method and program and a column for each mesh of any of them. Meshes are the variants
/// on the last axis of the file, named by their elements per side; every combination of the other axes has
/// its own tables.
std::string program_tables(const std::vector<const Verdict*>& family);

}  // namespace sandglass
