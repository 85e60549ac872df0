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
  double to_1_percent;    ///< displacements are this near to those at rest, of the largest imposed one
  double to_0_1_percent;  ///< likewise
  double to_rest;         ///< median of the runs
};

/// How one method brought one quasi-static case to rest.
struct RestRecord {
  std::string case_name;
  MethodChoice choice;
  std::string status;              ///< "ok", or "failed: why"
  long evaluations = 0;            ///< evaluations of the internal forces
  double residual = 0.0;           ///< |force on free components| / |reactions and loads|
  std::optional<RestTimes> times;  ///< none when it did not come to rest
};

/// The smallest n in [0, last] with error(n) < limit, by bisection: error(last) is taken to be below it, and
/// where the error crosses the limit more than once, one of the crossings is found.
long first_below(long last, double limit, const std::function<double(long)>& error);

/// Relaxes a scene three times, which gives time and displacements at rest, and then again with fewer and
/// fewer evaluations of the forces, to find after how many of them the displacements are that near to those
/// at rest. The seconds to 1 % and 0.1 % are this share of the evaluations times the seconds to rest: what
/// the preconditioner takes is spread evenly. A failed computation becomes a status. Throws
/// ComputationError when told to end.
RestRecord time_to_rest(const Scene& scene, const MethodChoice& choice, const Proceed& proceed);

/// Everything measured, as JSON: provenance, then one record per case, method, precision and number of
/// threads. Times of a run that did not come to rest are null.
std::string to_json(const Provenance& provenance, const std::vector<RestRecord>& records);

}  // namespace sandglass
