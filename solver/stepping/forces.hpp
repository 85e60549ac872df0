#pragma once

#include "model/model.hpp"

namespace sandglass {

/// Internal forces split into what is out of balance and what the constraints carry.
class Forces {
 public:
  explicit Forces(const Model& model);

  /// Evaluates the internal forces at u.
  void evaluate(const NodalField& u);

  /// Internal force (N); zero on constrained components.
  const NodalField& free() const { return free_; }

  /// Internal force (N) on constrained components, one per constraint: the reactions of a body at rest.
  const std::vector<double>& reactions() const { return reactions_; }

  /// |free| / |reactions|; without reactions the plain norm of the free forces (N).
  double residual() const;

 private:
  const Model& model_;
  NodalField free_;
  std::vector<double> reactions_;
};

}  // namespace sandglass
