#pragma once

#include <string>
#include <vector>

#include "benchmark/bench.hpp"
#include "benchmark/rest.hpp"
#include "benchmark/side_by_side.hpp"

namespace sandglass {

/// The records of one scene as a table with lines of at most 110 characters, in as many blocks as that takes.
/// Each block begins with the name and the unit of its columns.
std::string bench_table(const std::vector<BenchRecord>& records);

/// A warning that times were disturbed; empty if none were.
std::string spread_warning(const std::vector<BenchRecord>& records);

/// The times to static equilibrium of one scene as a table.
std::string rest_table(const Scene& scene, const std::vector<RestRecord>& records);

/// The times of many bodies of one case as a table.
std::string side_by_side_table(const std::vector<SideBySide>& records);

/// The speed of the machine, one line per number of threads.
std::string machine_lines(const BenchPlan& plan, MachineSpeed& machine);

}  // namespace sandglass
