#pragma once

#include <string>
#include <vector>

#include "comparison/verdict.hpp"

namespace sandglass {

/// For people: a table for every case file that has published values, a row for each method and a column for
/// each variant, of computed over published values; where there are truths, a second one of computed over
/// true values; where other programs are listed, their tables (`program_tables`). Verdicts without published
/// values are passed over.
std::string published_tables(const std::vector<Verdict>& verdicts);

}  // namespace sandglass
