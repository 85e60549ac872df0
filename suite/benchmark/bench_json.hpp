#pragma once

#include <string>
#include <vector>

#include "benchmark/bench.hpp"
#include "io/result_file.hpp"

namespace sandglass {

/// Everything measured, as JSON: provenance, machine, peaks and bandwidths by number of threads, records.
/// Figures of a variant whose result is wrong are null.
std::string to_json(const Provenance& provenance, const BenchPlan& plan, MachineSpeed& machine,
                    const std::vector<BenchRecord>& records);

}  // namespace sandglass
