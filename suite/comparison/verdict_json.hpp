#pragma once

#include <string>
#include <vector>

#include "comparison/verdict.hpp"
#include "io/result_file.hpp"

namespace sandglass {

/// verdicts.json: provenance once at the top, one record per (case, method, kappa, precision), one entry per
/// limit. Runs of cases with published values stand apart, in "published", with these values. Figures that do
/// not exist are null.
std::string to_json(const Provenance& provenance, const std::vector<Verdict>& verdicts,
                    const std::vector<LimitCheck>& limits);

}  // namespace sandglass
