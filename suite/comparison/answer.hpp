#pragma once

#include <functional>
#include <optional>
#include <string>

#include "comparison/finding.hpp"
#include "problem/observer.hpp"

namespace sandglass {

/// The outcome of a computation.
struct Answer {
  NodalField u;                         ///< m; empty where the computation broke down
  double energy = 0.0;                  ///< strain and hourglass energy at u, J
  std::optional<Finding> failure = {};  ///< how it broke down, or that it is not in equilibrium
  bool refused = false;                 ///< the method does not take this case
  std::string status = "ok";            ///< or why not, in words
  long steps = 0;
};

/// The static answer of a model, or that it is not in equilibrium. Throws as `relax` does.
Answer equilibrium_answer(const Model& model, Observer& observer);

/// The same for a scene and a method; errors become part of the answer.
Answer equilibrium_answer(const Scene& scene, const MethodChoice& choice, Observer& observer);

/// The result of `find`; errors that it throws become part of the answer.
Answer answer_of(const std::function<Answer()>& find);

}  // namespace sandglass
