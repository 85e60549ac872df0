#pragma once

#include <cmath>

#include "support/initial_value_problem.hpp"
#include "support/plain_assembly.hpp"

namespace sandglass::verification {

/// Displacements (m) and velocities (m/s) of all nodes at one time.
struct MotionAt {
  std::vector<double> u;
  std::vector<double> v;
};

/// A dynamic scene discretised only in space, M a + c M v + f = F(t): lumped masses, imposed displacements
/// and loads along eq. 15, f of the plain assembly with the elements' memory integrated in continuous time.
/// No part comes from the stepper or the model. For elastic laws.
template <class Method, class Law>
class SemiDiscrete {
 public:
  SemiDiscrete(const Scene& scene, const Law& law)
      : scene_(scene),
        assembly_(scene.mesh, law, {.kappa = {}, .density = scene.materials.list.front().density}),
        masses_(assembly_.numbers() / 3, 0.0),
        load_(assembly_.numbers(), 0.0),
        final_(assembly_.numbers(), 0.0),
        free_(assembly_.numbers(), true) {
    for (const auto& cell : scene.mesh.cells) {
      double volume = 0.0;  // two Gauss points per axis integrate det J of a trilinear hexahedron exactly
      for (const auto& xi : gauss_points()) {
        volume += determinant(parent_jacobian(gather(scene.mesh.points, cell), xi));
      }
      for (const int node : cell) masses_[index(node)] += scene.materials.list.front().density * volume / 8.0;
    }
    for (const auto& [node, force, curve] : dead_loads(scene.forces)) {
      for (std::size_t i = 0; i < 3; ++i) load_[3 * index(node) + i] = force[i];
    }
    for (const Constraint& constraint : scene.constraints) {
      const std::size_t k = 3 * index(constraint.node) + index(constraint.component);
      free_[k] = false;
      final_[k] = final_value(scene, constraint);  // its scenes do not turn: along a line
    }
  }

  const std::vector<double>& masses() const { return masses_; }

  /// The motion after the scene's duration, integrated with local errors below `tolerance` times the values.
  /// `displacement` (m) and `frequency` (rad/s) set the scale of errors where values are small.
  MotionAt solved(double tolerance, double displacement, double frequency) const {
    const std::size_t n = assembly_.numbers();
    std::vector<double> y(2 * n + PlainAssembly<Kernel, Law>::history_numbers * scene_.mesh.cells.size());
    std::vector<double> scale(y.size(), displacement * lightest() * frequency * frequency);
    std::fill_n(scale.begin(), n, displacement);
    std::fill_n(scale.begin() + static_cast<std::ptrdiff_t>(n), n, displacement * frequency);
    const std::vector<double> v = flat(scene_.initial_velocities);
    std::copy(v.begin(), v.end(), y.begin() + static_cast<std::ptrdiff_t>(n));
    const double duration = scene_.settings.dynamics.duration;
    y = solved_in_time([this](double t, const std::vector<double>& at) { return rate(t, at); }, std::move(y),
                       duration, tolerance, scale);
    return motion(duration, y);
  }

 private:
  using Kernel = FormulationOf<Method, Law>;

  double lightest() const { return *std::min_element(masses_.begin(), masses_.end()); }

  double relative_time(double t) const {
    const auto& dynamics = scene_.settings.dynamics;
    return std::min(1.0, t / (dynamics.ramp_time > 0.0 ? dynamics.ramp_time : dynamics.duration));
  }

  /// Eq. 15 and its derivative by time.
  double loading(double t) const {
    const double s = relative_time(t);
    return s * s * s * (10 - 15 * s + 6 * s * s);
  }
  double loading_rate(double t) const {
    const double s = relative_time(t);
    return t > 0.0 ? 30 * s * s * (1 - s) * (1 - s) * s / t : 0.0;
  }

  /// The free components of a state, and the imposed ones at its time.
  MotionAt motion(double t, const std::vector<double>& y) const {
    const std::size_t n = assembly_.numbers();
    MotionAt now{
        {y.begin(), y.begin() + static_cast<std::ptrdiff_t>(n)},
        {y.begin() + static_cast<std::ptrdiff_t>(n), y.begin() + static_cast<std::ptrdiff_t>(2 * n)}};
    for (std::size_t k = 0; k < n; ++k) {
      if (free_[k]) continue;
      now.u[k] = loading(t) * final_[k];
      now.v[k] = loading_rate(t) * final_[k];
    }
    return now;
  }

  /// u' = v, v' = (F - f) / m - c v, and the rates of histories.
  std::vector<double> rate(double t, const std::vector<double>& y) const {
    const std::size_t n = assembly_.numbers();
    const auto [u, v] = motion(t, y);
    const auto histories = assembly_.histories(y.data() + 2 * n);
    const std::vector<double> f = assembly_.force_in_motion(u, v, histories);
    std::vector<double> result(2 * n, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      if (!free_[k]) continue;
      result[k] = v[k];
      result[n + k] =
          (loading(t) * load_[k] - f[k]) / masses_[k / 3] - scene_.settings.dynamics.damping * v[k];
    }
    const std::vector<double> history_rates = assembly_.history_rates(u, v, histories);
    result.insert(result.end(), history_rates.begin(), history_rates.end());
    return result;
  }

  const Scene& scene_;
  PlainAssembly<Kernel, Law> assembly_;
  std::vector<double> masses_;  // of nodes, kg
  std::vector<double> load_;    // final, N
  std::vector<double> final_;   // imposed displacements, m
  std::vector<bool> free_;
};

}  // namespace sandglass::verification
