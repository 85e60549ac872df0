#pragma once

#include <functional>
#include <optional>
#include <string>

#include "comparison/accuracy.hpp"
#include "comparison/finding.hpp"
#include "problem/observer.hpp"

namespace sandglass {

/// The outcome of a computation, at rest or in motion.
struct Answer {
  Displacements u;                      ///< m, at the answer's times; empty where the computation broke down
  StrainEnergies energies;              ///< J, at the last of them
  std::optional<Finding> failure = {};  ///< how it broke down, or that it is not in equilibrium
  bool refused = false;                 ///< the method does not take this case
  std::string status = "ok";            ///< or why not, in words
  long steps = 0;                       ///< of a motion; of an answer at rest the evaluations of its search
  double residual = 0.0;                ///< of an answer at rest; see Relaxation
  double seconds = 0.0;  ///< wall time from the model to the answer; of a motion, that of its steps
};

/// The answer of a model, in motion where its case is dynamic; else that it is not in equilibrium. The
/// observer is asked whether to go on. Throws as `relax` and `integrate` do.
Answer compute_answer(const Model& model, Observer& observer);

/// The same for a scene and a method; errors become part of the answer.
Answer compute_answer(const Scene& scene, const MethodChoice& choice, Observer& observer);

/// The result of `find`; errors that it throws become part of the answer.
Answer answer_of(const std::function<Answer()>& find);

/// The unit of all relative errors against a reference (m); see displacement_unit in problem/scene.hpp.
double displacement_unit(const Scene& scene, const Displacements& reference);

}  // namespace sandglass
