#pragma once

#include <functional>
#include <optional>
#include <string>

#include "benchmark/measure.hpp"
#include "io/result_file.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// Wall times from the model to an answer, s.
struct RestTimes {
  double to_1_percent;    ///< until displacements are this close to the final ones, as a share of the largest
                          ///< imposed one
  double to_0_1_percent;  ///< likewise
  double to_rest;         ///< median of the runs
};

/// One method's way to the static equilibrium of one quasi-static case.
struct RestRecord {
  std::string case_name;
  MethodChoice choice;
  std::string status;              ///< "ok", or "failed: why"
  long evaluations = 0;            ///< evaluations of the internal forces
  double residual = 0.0;           ///< |force on free components| / |reactions and loads|
  std::optional<RestTimes> times;  ///< none if no equilibrium was found
};

/// The smallest n in [0, last] with error(n) < limit, by bisection: assumes that error(last) is below it; if
/// the error crosses the limit several times, finds one of the crossings.
long first_below(long last, double limit, const std::function<double(long)>& error);

/// Relaxes a scene three times for time and displacements in static equilibrium, and then again with fewer
/// evaluations of the forces, to find after how many of them the displacements are close enough. The seconds
/// to 1 % and 0.1 % are this share of the evaluations times the seconds to equilibrium, as if the
/// preconditioner's time were spread evenly. A failed computation becomes a status. Throws ComputationError
/// if interrupted.
RestRecord time_to_rest(const Scene& scene, const MethodChoice& choice, const Proceed& proceed);

/// All measurements as JSON: provenance, then one record per case, method, precision and number of threads.
/// Times of a run without equilibrium are null.
std::string to_json(const Provenance& provenance, const std::vector<RestRecord>& records);

}  // namespace sandglass
