#pragma once

#include "assembly/internal_force.hpp"

namespace sandglass {

/// Another processor, which computes the forces of elements. Everything else stays with this one.
class Processor {
 public:
  Processor() = default;
  Processor(const Processor&) = delete;
  Processor& operator=(const Processor&) = delete;
  virtual ~Processor() = default;

  /// Its name, as the system gives it.
  virtual std::string name() const = 0;

  /// Why it does not compute the forces of a method's elements with these materials; empty if it does.
  virtual std::string refusal(const Materials& materials, const MethodChoice& choice) const = 0;

  /// Elements whose forces the processor computes; `own` are the same elements on this one, of a mesh with
  /// these materials and this choice. Throws InputError, which says what is possible, for what it does not
  /// support, and for bodies that exceed its memory.
  virtual std::unique_ptr<InternalForce<double>> forces(std::unique_ptr<InternalForce<double>> own,
                                                        const Mesh& mesh, const Materials& materials,
                                                        const MethodChoice& choice) const = 0;
  virtual std::unique_ptr<InternalForce<float>> forces(std::unique_ptr<InternalForce<float>> own,
                                                       const Mesh& mesh, const Materials& materials,
                                                       const MethodChoice& choice) const = 0;
};

/// Elements that leave everything but their forces to others.
template <class Real>
class DelegatingForce : public InternalForce<Real> {
 public:
  explicit DelegatingForce(std::unique_ptr<InternalForce<Real>> own) : own_(std::move(own)) {}

  const Layout& layout() const override { return own_->layout(); }
  State<Real> undeformed() const override { return own_->undeformed(); }
  bool needs_increment() const override { return own_->needs_increment(); }
  void gather(State<Real>& state) const override { own_->gather(state); }
  StrainEnergies energies(const State<Real>& state) const override { return own_->energies(state); }
  void hourglass_energy_densities(const State<Real>& state, std::span<double> densities) const override {
    own_->hourglass_energy_densities(state, densities);
  }
  void jacobians(const State<Real>& state, std::span<double> jacobians) const override {
    own_->jacobians(state, jacobians);
  }
  void smallest_jacobians(const State<Real>& state, std::span<double> jacobians) const override {
    own_->smallest_jacobians(state, jacobians);
  }
  void stresses(const State<Real>& state, const Rows<Real>& coordinates,
                std::span<double> stresses) const override {
    own_->stresses(state, coordinates, stresses);
  }
  void powers(const State<Real>& state, const Rows<Real>& v, std::span<double> powers) const override {
    own_->powers(state, v, powers);
  }
  void stiffness_bounds(const State<Real>& state, std::span<double> bounds) const override {
    own_->stiffness_bounds(state, bounds);
  }
  Adaptation adapt(State<Real>& state, const Rows<Real>& mobility, double length,
                   double demoting_length) const override {
    return own_->adapt(state, mobility, length, demoting_length);
  }
  std::vector<double> levels(const State<Real>& state) const override { return own_->levels(state); }
  void set_levels(State<Real>& state, const std::vector<double>& levels) const override {
    own_->set_levels(state, levels);
  }
  void replace_pressures(const State<Real>& state, std::span<const Real> p, std::span<const double> lambdas,
                         Rows<Real>& force, std::span<Real> defect) const override {
    own_->replace_pressures(state, p, lambdas, force, defect);
  }

 private:
  std::unique_ptr<InternalForce<Real>> own_;
};

}  // namespace sandglass
