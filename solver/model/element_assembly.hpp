#pragma once

#include <vector>

#include "model/internal_force.hpp"

namespace sandglass {

/// All elements of one formulation, their constants computed once. Elements are added in their order, so that
/// the same input gives the same bits.
template <class Formulation, class Law>
class ElementAssembly final : public InternalForce {
 public:
  ElementAssembly(const Mesh& mesh, const Law& law, const HourglassSettings& settings)
      : cells_(mesh.cells), law_(law) {
    elements_.reserve(cells_.size());
    for (const auto& cell : cells_) {
      elements_.push_back(Formulation::precompute(gather(mesh.points, cell), law_, settings));
    }
  }

  // Without `flatten` the compiler leaves small matrix functions out of line, which costs a third of the
  // time.
  [[gnu::flatten]] void evaluate(const NodalField& u, NodalField& force) const override {
    const Law law = law_;  // a copy that no store can alias: its moduli are computed once
    std::fill(force.begin(), force.end(), Vector{});
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      scatter_add(Formulation::force(gather(u, cells_[e]), elements_[e], law), cells_[e], force);
    }
  }

  StrainEnergies energies(const NodalField& u) const override {
    StrainEnergies sum;
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      const auto energy = Formulation::energy(gather(u, cells_[e]), elements_[e], law_);
      sum.strain += energy.strain;
      sum.hourglass += energy.hourglass;
    }
    return sum;
  }

  void hourglass_energy_densities(const NodalField& u, std::span<double> densities) const override {
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      const auto energy = Formulation::energy(gather(u, cells_[e]), elements_[e], law_);
      densities[e] = energy.hourglass / elements_[e].body.V;
    }
  }

  void jacobians(const NodalField& u, std::span<double> jacobians) const override {
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      jacobians[e] = Formulation::mean_jacobian(gather(u, cells_[e]), elements_[e]);
    }
  }

  void smallest_jacobians(const NodalField& u, std::span<double> jacobians) const override {
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      jacobians[e] = Formulation::smallest_jacobian(gather(u, cells_[e]), elements_[e]);
    }
  }

  void stiffness_bounds(const NodalField& u, std::span<double> bounds) const override {
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      bounds[e] = Formulation::stiffness_bound(gather(u, cells_[e]), elements_[e], law_);
    }
  }

 private:
  std::vector<Hexahedron> cells_;
  std::vector<typename Formulation::template Element<double>> elements_;
  Law law_;
};

}  // namespace sandglass
