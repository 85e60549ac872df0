#pragma once

#include "stability/axis.hpp"
#include "stability/trial_answer.hpp"

namespace sandglass {

/// What a map says at one place about one method.
struct Cell {
  std::string method;
  double x = 0.0;
  double y = 0.0;
  std::optional<Finding> finding =
      {};  ///< none where the golden itself failed, or the method rejected the case
  std::optional<Symptoms> symptoms = {};  ///< none where there is nothing to compare
  std::string status = "ok";              ///< or why there is no finding, or how it broke down
  bool golden_failed = false;
  bool refused = false;
  long steps = 0;
};

/// Computes a cell. A run that breaks down says how, whether or not the golden does. A dynamic run is
/// unstable when it breaks down, or strays by more than `limit`, where the same method at half the stable
/// step does not. Else the finding follows from the symptoms compared with the golden's element on the same
/// mesh, good up to `limit`.
Cell compute_cell(const Map& map, const Case& description, const std::string& method, double x, double y,
                  double limit, Answers& answers);

}  // namespace sandglass
