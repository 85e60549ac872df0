#pragma once

#include "forces/body_force.hpp"

namespace sandglass {

/// Forces at nodes that the motion of the body does not change: what dead forces and weight come to.
class DeadLoads final : public BodyForce {
 public:
  /// `loads` (N, at the factor one) are sorted by curve and node, and are not empty; `size` is that of the
  /// tables they are from.
  explicit DeadLoads(std::vector<NodalLoad> loads, const LoadSize& size = {});

  void add_forces(std::span<const double> factors, const NodalMotion& motion,
                  AtNodes<Row<double>> forces) const override;
  void add_potential(std::span<const double> factors, AtNodes<const Row<double>> u,
                     double& sum) const override;
  void add_rates(std::span<const double> /*largest*/, std::span<const double> /*masses*/,
                 std::span<LoadRates> /*rates*/) const override {}
  void add_stiffness(AtNodes<Row<float>> /*diagonal*/) const override {}
  void add_size(LoadSize& size) const override;
  std::span<const NodalLoad> dead_loads() const override { return loads_; }
  std::shared_ptr<const BodyForce> restricted_to(const MeshPart& part) const override;
  std::shared_ptr<const BodyForce> held_at(std::span<const double> factors) const override;

 private:
  std::vector<NodalLoad> loads_;
  std::vector<std::size_t> places_;  // of the nodes of the loads
  LoadSize size_;
};

}  // namespace sandglass
