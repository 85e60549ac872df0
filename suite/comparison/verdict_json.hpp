#pragma once

#include <string>
#include <vector>

#include "comparison/verdict.hpp"
#include "io/result_file.hpp"

namespace sandglass {

/// verdicts.json: provenance at the top, one record per (case, method, kappa, precision), one entry per
/// limit. Runs of cases with published values are listed separately, in "published", with these values.
/// Missing figures are null.
std::string to_json(const Provenance& provenance, const std::vector<Verdict>& verdicts,
                    const std::vector<LimitCheck>& limits);

}  // namespace sandglass
