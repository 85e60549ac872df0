#pragma once

#include <string>
#include <vector>

#include "benchmark/bench.hpp"
#include "io/result_file.hpp"

namespace sandglass {

/// All measurements as JSON: provenance, machine, peaks and bandwidths by number of threads, records. Figures
/// of a variant with a wrong result are null.
std::string to_json(const Provenance& provenance, const BenchPlan& plan, MachineSpeed& machine,
                    const std::vector<BenchRecord>& records);

}  // namespace sandglass
