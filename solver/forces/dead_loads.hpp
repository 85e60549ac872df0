#pragma once

#include "forces/body_force.hpp"

namespace sandglass {

/// The magnitude of the load of a table, whatever its direction.
struct LoadSize {
  double force;   ///< N
  double moment;  ///< N m
};

/// Nodal forces that do not depend on the motion of the body: dead forces and weight.
class DeadLoads final : public BodyForce {
 public:
  /// `loads` (N, at the factor one) are sorted by curve and node and not empty; `sizes` are the magnitudes of
  /// their tables.
  explicit DeadLoads(std::vector<NodalLoad> loads, std::vector<LoadSize> sizes = {});

  void add_forces(Factors factors, const NodalMotion& motion, AtNodes<Row<double>> forces) const override;
  void add_potential(Factors factors, NodalRows u, double& sum) const override;
  void add_rates(Factors, const std::vector<double>&, std::vector<LoadRates>&) const override {}
  void add_stiffness(AtNodes<Row<float>> /*diagonal*/) const override {}
  void add_size(double arm, double& sum) const override;
  std::span<const NodalLoad> dead_loads() const override { return loads_; }
  std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const override;

 private:
  std::vector<NodalLoad> loads_;
  std::vector<LoadSize> sizes_;
};

}  // namespace sandglass
