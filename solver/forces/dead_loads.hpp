#pragma once

#include <functional>
#include <optional>

#include "forces/body_force.hpp"

namespace sandglass {

/// The magnitude of the load of a table, whatever its direction.
struct LoadSize {
  double force;   ///< N
  double moment;  ///< N m
};

/// How the loads of a table depend on the shape of the body; see BodyForce::add_slopes.
using SlopesOfLoad = std::function<void(Factors, const ShapeSlopes&)>;

/// Nodal forces that do not depend on the motion of the body: dead forces and weight.
class DeadLoads final : public BodyForce {
 public:
  /// `loads` (N, at the factor one) are sorted by curve and node and not empty; `sizes` are the magnitudes of
  /// their tables, `slopes` how they depend on the shape of the body, if that is known.
  explicit DeadLoads(std::vector<NodalLoad> loads, std::vector<LoadSize> sizes = {},
                     std::optional<std::vector<SlopesOfLoad>> slopes = std::nullopt);

  void add_forces(Factors factors, const NodalMotion& motion, AtNodes<Row<double>> forces) const override;
  void add_derivatives_of_power(Factors, const NodalMotion&, NodalRows, AtNodes<Row<double>>,
                                AtNodes<Row<double>>) const override {}
  void add_potential(Factors factors, NodalRows u, double& sum) const override;
  void add_slopes(Factors factors, const ShapeSlopes& shape) const override;
  void add_rates(Factors, const std::vector<double>&, std::vector<LoadRates>&) const override {}
  void add_stiffness(AtNodes<Row<float>> /*diagonal*/) const override {}
  void add_size(double arm, double& sum) const override;
  std::span<const NodalLoad> dead_loads() const override { return loads_; }
  std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const override;

 private:
  std::vector<NodalLoad> loads_;
  std::vector<LoadSize> sizes_;
  std::optional<std::vector<SlopesOfLoad>> slopes_;
};

}  // namespace sandglass
