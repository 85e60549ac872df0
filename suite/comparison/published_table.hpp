#pragma once

#include <string>
#include <vector>

#include "comparison/verdict.hpp"

namespace sandglass {

/// As text: for every case file with published values, a table of computed over published values with a row
/// for each method and a column for each variant; with truths, a second one of computed over true values;
/// with other programs, their tables (`program_tables`). Verdicts without published values are skipped.
std::string published_tables(const std::vector<Verdict>& verdicts);

}  // namespace sandglass
