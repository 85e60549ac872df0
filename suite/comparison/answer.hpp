#pragma once

#include <functional>
#include <optional>
#include <string>

#include "comparison/accuracy.hpp"
#include "comparison/finding.hpp"
#include "comparison/published.hpp"
#include "problem/observer.hpp"

namespace sandglass {

/// The outcome of a static or dynamic computation.
struct Answer {
  Displacements u;                       ///< m, at the answer's times; empty if the computation broke down
  StrainEnergies energies;               ///< J, at the last of them
  std::vector<ReactionsAt> checks = {};  ///< of a scene with contact
  std::optional<Finding> failure = {};   ///< how it broke down, or that it is not in equilibrium
  bool refused = false;                  ///< the method does not support this case
  std::string status = "ok";             ///< or the reason why not
  long steps = 0;                        ///< of a motion; of a static answer, evaluations of its search
  double residual = 0.0;                 ///< of a static answer; see Relaxation
  double seconds = 0.0;  ///< wall time from the model to the answer; of a motion, wall time of its steps
};

/// The answer of a model, static or dynamic as its case. The observer is asked whether to continue. Throws as
/// `relax` and `integrate` do.
Answer compute_answer(const Model& model, Observer& observer);

/// The same for a scene and a method; an error becomes part of the answer.
Answer compute_answer(const Scene& scene, const MethodChoice& choice, Observer& observer);

/// The result of `find`; an error that it throws becomes part of the answer.
Answer answer_of(const std::function<Answer()>& find);

/// The unit of all relative errors against a reference (m); see displacement_unit in problem/scene.hpp.
double displacement_unit(const Scene& scene, const Displacements& reference);

}  // namespace sandglass
