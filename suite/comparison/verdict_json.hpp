#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "comparison/verdict.hpp"
#include "io/result_file.hpp"

namespace sandglass {

/// The figures of symptoms; null if there are none.
nlohmann::ordered_json to_record(const std::optional<Symptoms>& symptoms);

/// verdicts.json: provenance at the top, one record per (case, method, kappa, precision), one entry per
/// limit. Runs of cases with published values are listed separately, in "published", with these values.
/// Missing figures are null.
std::string to_json(const Provenance& provenance, const std::vector<Verdict>& verdicts,
                    const std::vector<LimitCheck>& limits);

}  // namespace sandglass
