#pragma once

#include <map>
#include <span>

#include "solve/sensitivities.hpp"

namespace sandglass {

/// A step of a motion.
struct TakenStep {
  double time;  ///< s, at its end
  double size;  ///< s
};

/// The steps of a motion as it proceeds; those that it repeats with shorter ones are forgotten.
class TakenSteps {
 public:
  void add(double time, double size) {
    while (!steps_.empty() && steps_.back().time >= time) steps_.pop_back();
    steps_.push_back({time, size});
  }

  std::span<const TakenStep> all() const { return steps_; }

  /// The number of steps up to a time (s) at which one ended.
  std::size_t until(double time) const;

 private:
  std::vector<TakenStep> steps_;
};

/// Throws InputError with the reason why the derivatives of a motion of a model are not available.
void require_differentiable_motion(const Model& model);

/// The derivatives of a scalar J of a motion by everything that it depends on, with its steps as they were.
/// `of_displacements` has dJ/du (1/m) at all nodes, by the number of steps after which u is taken. The motion
/// is computed again, and `last` must be its displacements (m) after the last of these steps; the adjoint of
/// each step follows in reverse. Positions of nodes are not available. Throws ComputationError if the motion
/// is not the same again.
Gradient gradient_of_motion(const Model& model, std::span<const TakenStep> steps,
                            const std::map<std::size_t, NodalField>& of_displacements, const NodalField& last,
                            const Wanted& wanted = {});

}  // namespace sandglass
