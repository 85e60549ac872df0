#include "stepping/dynamic_relaxation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "model/loading.hpp"
#include "stepping/field.hpp"
#include "stepping/forces.hpp"
#include "stepping/health.hpp"

namespace sandglass {

namespace {

/// Enough steps that the driven nodes never move faster than this share of the shear wave of the smallest
/// element.
int choose_ramp_steps(const Model& model) {
  const auto& scene = model.scene();
  if (scene.description.relaxation.ramp_steps > 0) return scene.description.relaxation.ramp_steps;
  constexpr double share = 0.3;
  const auto& masses = model.element_masses();
  const double h = std::cbrt(*std::min_element(masses.begin(), masses.end()) / scene.description.density);
  const double shear_over_pressure_wave = std::visit(
      [](const auto& law) {
        return std::sqrt(law.shear_modulus() / (lame_lambda(law) + 2.0 * law.shear_modulus()));
      },
      scene.description.law);
  // In one step of an equally critical mesh a pressure wave crosses h / sqrt(3).
  const double shear_wave = h / std::sqrt(3.0) * shear_over_pressure_wave;
  const double steps = steepest_loading * largest_imposed(scene) / (share * shear_wave);
  return std::max(100, static_cast<int>(std::ceil(steps)));
}

/// Masses with which the step 1 is `step_fraction` of the stable one in every element; kept up with
/// stiffening.
class ScaledMasses {
 public:
  explicit ScaledMasses(const Model& model)
      : model_(model),
        bounds_(model.element_masses().size(), 0.0),
        needed_(bounds_.size()),
        nodal_(model.masses().size()) {}

  /// Takes new masses when an element has become stiffer than its masses allow.
  void update(const NodalField& u) {
    model_.internal_force().stiffness_bounds(u, needed_);
    bool enough = true;
    for (std::size_t e = 0; e < bounds_.size(); ++e) enough = enough && needed_[e] <= bounds_[e];
    if (enough) return;
    bounds_ = needed_;
    const double fraction = model_.scene().description.relaxation.step_fraction;
    std::fill(nodal_.begin(), nodal_.end(), 0.0);
    const auto& cells = model_.scene().mesh.cells;
    for (std::size_t e = 0; e < cells.size(); ++e) {
      const double mass = bounds_[e] / (4.0 * fraction * fraction);  // omega = 2 fraction / 1
      for (const int node : cells[e]) nodal_[static_cast<std::size_t>(node)] += mass;
    }
  }

  const std::vector<double>& nodal() const { return nodal_; }

 private:
  const Model& model_;
  std::vector<double> bounds_;
  std::vector<double> needed_;
  std::vector<double> nodal_;
};

/// Critical damping of the lowest frequency in motion, from the Rayleigh quotient of the last increment.
class AdaptiveDamping {
 public:
  explicit AdaptiveDamping(const Model& model) : previous_(model.masses().size()) {}

  /// 2 omega with omega^2 = du . df / du . M du for the increment du that led to these forces.
  double coefficient(const std::vector<double>& masses, const NodalField& increment,
                     const NodalField& force) {
    double stiffness = 0.0;
    for (std::size_t n = 0; n < force.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) stiffness += increment[n][i] * (force[n][i] - previous_[n][i]);
    }
    previous_ = force;
    const double mass = weighted_dot(masses, increment, increment);
    const double square = mass > 0.0 ? std::clamp(stiffness / mass, 0.0, 1.0) : 0.0;
    return 2.0 * std::sqrt(square);
  }

 private:
  NodalField previous_;
};

}  // namespace

Relaxation relax(const Model& model, Observer& observer) {
  const RelaxationSettings& settings = model.scene().description.relaxation;
  const std::size_t n_nodes = model.masses().size();
  const int ramp_steps = choose_ramp_steps(model);
  const auto& constraints = model.scene().constraints;

  Relaxation result{.u = NodalField(n_nodes)};
  NodalField& u = result.u;
  NodalField v(n_nodes);  // increment per step; zero on constrained components
  Forces forces(model);
  ScaledMasses masses(model);
  AdaptiveDamping damping(model);
  std::vector<double> reactions(constraints.size(), 0.0);
  double work = 0.0;
  int frames = 0;

  masses.update(u);
  observer.frame(0.0, u, v);
  observer.history({0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0 / ramp_steps});
  const auto start = std::chrono::steady_clock::now();
  for (long step = 1; step <= settings.max_steps; ++step) {
    const double ramp = static_cast<double>(step) / ramp_steps;
    const double advance = loading_curve(ramp) - loading_curve(ramp - 1.0 / ramp_steps);
    model.impose(loading_curve(ramp), u);
    forces.evaluate(u);
    const double c = damping.coefficient(masses.nodal(), v, forces.free());
    for (std::size_t n = 0; n < n_nodes; ++n) {
      const double mass = masses.nodal()[n];
      for (std::size_t i = 0; i < 3; ++i) {
        v[n][i] = ((2.0 - c) * v[n][i] - 2.0 * forces.free()[n][i] / mass) / (2.0 + c);
      }
    }
    for (std::size_t k = 0; k < constraints.size(); ++k) {
      work += 0.5 * (reactions[k] + forces.reactions()[k]) * advance * constraints[k].value;
      reactions[k] = forces.reactions()[k];
    }
    result.steps = step;
    result.residual = forces.residual();
    result.converged = step >= ramp_steps && result.residual < settings.tolerance;

    const bool check =
        step % settings.check_interval == 0 || result.converged || !std::isfinite(result.residual);
    if (check) {
      require_healthy(model, u, step);
      const StrainEnergies energies = model.internal_force().energies(u);
      observer.history({ramp, 0.5 * weighted_dot(masses.nodal(), v, v), energies.strain, energies.hourglass,
                        work, result.residual, 1.0 / ramp_steps});
      const double digits =
          std::log(std::max(result.residual, settings.tolerance)) / std::log(settings.tolerance);
      result.interrupted =
          !observer.proceed(step, std::min(1.0, 0.5 * std::min(ramp, 1.0) + 0.5 * digits), result.residual);
      masses.update(u);
    }
    if (step < ramp_steps && step * settings.frames >= static_cast<long>(frames + 1) * ramp_steps) {
      ++frames;
      observer.frame(ramp, u, v);
    }
    if (result.converged || result.interrupted) break;
    if (step == settings.max_steps) break;
    for (std::size_t n = 0; n < n_nodes; ++n) {
      for (std::size_t i = 0; i < 3; ++i) u[n][i] += v[n][i];
    }
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  observer.frame(std::max(1.0, static_cast<double>(result.steps) / ramp_steps), u, NodalField(n_nodes));
  return result;
}

}  // namespace sandglass
