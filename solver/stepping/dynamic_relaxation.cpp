#include "stepping/dynamic_relaxation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "model/loading.hpp"
#include "stepping/body.hpp"
#include "stepping/row_loops.hpp"

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
      : model_(model), bounds_(model.element_masses().size(), 0.0), nodal_(model.masses().size()) {}

  /// Takes new masses when an element has become stiffer than its masses allow; returns whether it did.
  bool update(const std::vector<double>& needed) {
    bool enough = true;
    for (std::size_t e = 0; e < bounds_.size(); ++e) enough = enough && needed[e] <= bounds_[e];
    if (enough) return false;
    bounds_ = needed;
    const double fraction = model_.scene().description.relaxation.step_fraction;
    std::fill(nodal_.begin(), nodal_.end(), 0.0);
    const auto& cells = model_.scene().mesh.cells;
    for (std::size_t e = 0; e < cells.size(); ++e) {
      const double mass = bounds_[e] / (4.0 * fraction * fraction);  // omega = 2 fraction / 1
      for (const int node : cells[e]) nodal_[static_cast<std::size_t>(node)] += mass;
    }
    return true;
  }

  const std::vector<double>& nodal() const { return nodal_; }
  std::vector<double> inverses() const {
    std::vector<double> values = nodal_;
    for (double& value : values) value = 1.0 / value;
    return values;
  }

 private:
  const Model& model_;
  std::vector<double> bounds_;
  std::vector<double> nodal_;
};

/// What the last increment du tells of the body: du . df and du . M du.
struct RayleighSums {
  double stiffness = 0.0;
  double mass = 0.0;
  RayleighSums& operator+=(const RayleighSums& other) {
    stiffness += other.stiffness;
    mass += other.mass;
    return *this;
  }
};

/// Central differences with the step 1, scaled masses and critical damping of the lowest frequency in motion.
template <class Real>
class PseudoDynamics {
 public:
  PseudoDynamics(const Model& model, const InternalForce<Real>& elements)
      : masses_(model), body_(model, elements), previous_force_(body_.free_forces().size()) {
    update_masses();
  }

  Body<Real>& body() { return body_; }

  void update_masses() {
    if (!masses_.update(body_.stiffness_bounds())) return;
    mass_ = body_.on_free_components(masses_.nodal());
    inverse_mass_ = body_.on_free_components(masses_.inverses());
  }

  /// 2 omega with omega^2 = du . df / du . M du for the increment du that led to these forces (N/m over kg).
  double damping() {
    const Real *du = numbers_of(body_.state().increment), *f = numbers_of(body_.free_forces());
    const Real *m = numbers_of(mass_), *before = numbers_of(previous_force_);
    const auto sums = sum_over_blocks<RayleighSums>(
        4 * mass_.size(), body_.threads(), [=](std::size_t first, std::size_t last) {
          Real stiffness = 0, mass = 0;
#pragma omp simd reduction(+ : stiffness, mass)
          for (std::size_t k = first; k < last; ++k) {
            stiffness += du[k] * (f[k] - before[k]);
            mass += du[k] * m[k] * du[k];
          }
          return RayleighSums{static_cast<double>(stiffness), static_cast<double>(mass)};
        });
    const double square = sums.mass > 0.0 ? std::clamp(sums.stiffness / sums.mass, 0.0, 1.0) : 0.0;
    return 2.0 * std::sqrt(square);
  }

  /// Increments and displacements of the next step, damped by c.
  void advance(double c) {
    const auto keep = static_cast<Real>((2.0 - c) / (2.0 + c)), gain = static_cast<Real>(-2.0 / (2.0 + c));
    Real *u = numbers_of(body_.state().u), *du = numbers_of(body_.state().increment);
    Real* before = numbers_of(previous_force_);
    const Real *f = numbers_of(body_.free_forces()), *inverse = numbers_of(inverse_mass_);
    for_each_block(4 * mass_.size(), body_.threads(), [=](std::size_t first, std::size_t last) {
#pragma omp simd
      for (std::size_t k = first; k < last; ++k) {
        du[k] = keep * du[k] + gain * inverse[k] * f[k];
        u[k] += du[k];
        before[k] = f[k];
      }
    });
  }

  /// Kinetic energy of the last increment, J.
  double kinetic_energy() {
    const Real *du = numbers_of(body_.state().increment), *m = numbers_of(mass_);
    return 0.5 * sum_over_blocks<double>(4 * mass_.size(), body_.threads(),
                                         [=](std::size_t first, std::size_t last) {
                                           double sum = 0.0;
                                           for (std::size_t k = first; k < last; ++k) {
                                             sum += static_cast<double>(du[k] * m[k] * du[k]);
                                           }
                                           return sum;
                                         });
  }

 private:
  ScaledMasses masses_;
  Body<Real> body_;
  Rows<Real> mass_;
  Rows<Real> inverse_mass_;
  Rows<Real> previous_force_;
};

template <class Real>
Relaxation relax_body(const Model& model, const InternalForce<Real>& elements, Observer& observer) {
  const RelaxationSettings& settings = model.scene().description.relaxation;
  const int ramp_steps = choose_ramp_steps(model);
  const auto& constraints = model.scene().constraints;
  PseudoDynamics<Real> scheme(model, elements);
  Body<Real>& body = scheme.body();
  Relaxation result;
  std::vector<double> reactions(constraints.size(), 0.0);
  double work = 0.0;
  int frames = 0;

  const NodalField no_velocity(model.masses().size());
  observer.frame(body.frame(0.0, no_velocity));
  observer.history({0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0 / ramp_steps});
  const auto start = std::chrono::steady_clock::now();
  for (long step = 1; step <= settings.max_steps; ++step) {
    const double ramp = static_cast<double>(step) / ramp_steps;
    const double advance = loading_curve(ramp) - loading_curve(ramp - 1.0 / ramp_steps);
    body.impose(loading_curve(ramp));
    body.evaluate_forces();
    for (std::size_t k = 0; k < constraints.size(); ++k) {
      work += 0.5 * (reactions[k] + body.reactions()[k]) * advance * constraints[k].value;
      reactions[k] = body.reactions()[k];
    }
    result.steps = step;
    result.residual = body.residual();
    result.converged = step >= ramp_steps && result.residual < settings.tolerance;

    const bool check =
        step % settings.check_interval == 0 || result.converged || !std::isfinite(result.residual);
    const double damping = scheme.damping();
    if (check) {
      body.require_healthy(step);
      const StrainEnergies energies = body.energies();
      observer.history({ramp, scheme.kinetic_energy(), energies.strain, energies.hourglass, work,
                        result.residual, 1.0 / ramp_steps});
      const double digits =
          std::log(std::max(result.residual, settings.tolerance)) / std::log(settings.tolerance);
      result.interrupted =
          !observer.proceed(step, std::min(1.0, 0.5 * std::min(ramp, 1.0) + 0.5 * digits), result.residual);
      scheme.update_masses();
    }
    if (step < ramp_steps && step * settings.frames >= static_cast<long>(frames + 1) * ramp_steps) {
      ++frames;
      observer.frame(body.frame(ramp, body.field(body.state().increment)));
    }
    if (result.converged || result.interrupted || step == settings.max_steps) break;
    scheme.advance(damping);
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.u = body.field(body.state().u);
  result.energies = body.energies();
  observer.frame(body.frame(std::max(1.0, static_cast<double>(result.steps) / ramp_steps), no_velocity));
  return result;
}

}  // namespace

Relaxation relax(const Model& model, Observer& observer) {
  return std::visit([&](const auto& elements) { return relax_body(model, *elements, observer); },
                    model.internal_force());
}

}  // namespace sandglass
