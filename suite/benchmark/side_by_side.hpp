#pragma once

#include <string>

#include "assembly/internal_force.hpp"
#include "benchmark/measure.hpp"
#include "benchmark/statistics.hpp"
#include "io/result_file.hpp"
#include "problem/case.hpp"

namespace sandglass {

/// Many bodies of one case, one simulation after another and as a batch.
struct SideBySide {
  std::string case_name;
  std::size_t elements;  ///< of a body
  std::size_t bodies;
  MethodChoice choice;
  std::string status;  ///< "ok", or "wrong result: ..."
  Spread one_by_one;   ///< ns per element and step
  Spread batch;        ///< ns per element and step of a body
  double ratio;        ///< of the medians, batch over one by one
};

/// Moves `bodies` bodies of a case with imposed displacements, each a little farther than the last, one by
/// one and as a batch in turn, in frames of 20 steps, including checks of health. Afterwards all
/// displacements are compared. Throws InputError for a case that a batch does not support, ComputationError
/// if interrupted.
SideBySide time_side_by_side(const Case& description, const MethodChoice& choice, std::size_t bodies,
                             int repetitions, const Proceed& proceed);

/// As JSON.
std::string to_json(const Provenance& provenance, const std::vector<SideBySide>& records);

}  // namespace sandglass
