#pragma once

#include "stability/axis.hpp"
#include "stability/trial_answer.hpp"

namespace sandglass {

/// One cell of a map, for one method.
struct Cell {
  std::string method;
  double x = 0.0;
  double y = 0.0;
  std::optional<Finding> finding =
      {};  ///< none if the golden's element failed, or the method does not support the case
  std::optional<Symptoms> symptoms = {};  ///< none if there is nothing to compare
  std::string status = "ok";              ///< or the reason for no finding, or how it broke down
  bool golden_failed = false;
  bool refused = false;
  long steps = 0;
};

/// Computes a cell. A run that breaks down gets that finding, even if the golden's element breaks down too. A
/// dynamic run is unstable if it breaks down, or deviates by more than `limit`, while the same method at half
/// the stable step does not. Otherwise the finding follows from the symptoms compared with the golden's
/// element on the same mesh, good up to `limit`.
Cell compute_cell(const Map& map, const Case& description, const std::string& method, double x, double y,
                  double limit, Answers& answers);

}  // namespace sandglass
