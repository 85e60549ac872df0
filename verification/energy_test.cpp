/// Energy in free, undamped motions.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "assembly/method_entry.hpp"
#include "base/error.hpp"
#include "solve/central_difference.hpp"
#include "support/random_scene.hpp"

namespace sandglass::verification::energy_test {
namespace {

/// A different scene for each number: a free box of 8 to 96 elements, half of them distorted; Poisson's ratio
/// from 0 to .4999; an initial velocity that makes a standing wave with strains of about 1 to 30 %, without
/// momentum, so that the box stays where single precision resolves it.
class FreeMotion {
 public:
  FreeMotion(long seed, long number) : random_(static_cast<std::uint64_t>(7000003 * seed + number)) {
    constexpr std::array ratios{0.0, 0.3, 0.45, 0.49, 0.499, 0.4999};
    law_.poisson_ratio = ratios[index(whole(0, 5))];
    const std::array<int, 3> elements{whole(2, 4), whole(2, 4), whole(2, 6)};
    for (std::size_t i = 0; i < 3; ++i) size_[i] = 0.01 * random_.uniform(0.6, 1.6) * elements[i];
    mesh_ = box(size_, elements);
    if (random_.uniform(0.0, 1.0) < 0.5) {
      for (Vector& X : mesh_.points) {
        for (double& x : X) x += random_.uniform(-0.001, 0.001);
      }
    }
    strain_ = std::pow(10.0, random_.uniform(-2.0, std::log10(0.3)));
    Vector v{random_.uniform(-1.0, 1.0), random_.uniform(-1.0, 1.0), random_.uniform(-1.0, 1.0)};
    const double speed = strain_ * std::sqrt(law_.young_modulus / density) / length(v);
    for (double& x : v) x *= speed;
    velocity_ = {.value = v, .half_waves = {whole(0, 1), whole(0, 1), whole(1, 2)}};
  }

  /// A motion of some periods of the slowest shear wave across the box.
  Scene scene(double periods, const DynamicsSettings& settings) const {
    Case description = plain_case(law_, density);
    description.quasi_static = false;
    description.dynamics = settings;
    const double shear_speed = std::sqrt(law_.shear_modulus() / density);
    description.dynamics.duration =
        2.0 * periods * *std::max_element(size_.begin(), size_.end()) / shear_speed;
    description.velocities = {velocity_};
    const Scene moving = make_scene(description, mesh_);
    const std::vector<double> masses = Model(moving, {"tl-perturbation"}).masses();
    double mass = 0.0;
    Vector momentum{};
    for (std::size_t n = 0; n < masses.size(); ++n) {
      mass += masses[n];
      for (std::size_t i = 0; i < 3; ++i) momentum[i] += masses[n] * moving.initial_velocities[n][i];
    }
    for (double& p : momentum) p /= -mass;
    description.velocities.push_back({.value = momentum});
    return make_scene(description, mesh_);
  }

  double poisson_ratio() const { return law_.poisson_ratio; }
  double strain() const { return strain_; }

 private:
  static constexpr double density = 1000.0;

  int whole(int low, int high) { return low + static_cast<int>(random_.uniform(0.0, high - low + 1.0)); }

  RandomGeometry random_;
  NeoHookean law_{.young_modulus = 3000.0};
  std::array<double, 3> size_{};
  Mesh mesh_;
  double strain_ = 0.0;
  InitialVelocity velocity_;
};

/// The methods whose forces depend only on displacements and resist all deformations.
std::vector<std::string_view> conservative_methods(const Scene& scene) {
  std::vector<std::string_view> names;
  for (const MethodEntry& method : methods()) {
    if (!method.controls_hourglass || method.is_condensed || method.adapts()) continue;
    const Model model(scene, {std::string(method.name)});
    if (std::visit([](const auto& elements) { return elements->needs_increment(); }, model.internal_force()))
      continue;
    names.push_back(method.name);
  }
  return names;
}

/// The largest gain of kinetic plus strain energy is a percent, which shorter steps after strong compression
/// may cause; steps adjusted to a vibration would gain as much in every ten periods. For more and longer
/// scenes, SANDGLASS_SCENES=100 SANDGLASS_PERIODS=1000 energy_test prints a row for each.
TEST(Energy, of_free_motions_does_not_grow) {
  const long first = from_environment("SANDGLASS_FIRST", 0), count = from_environment("SANDGLASS_SCENES", 24);
  const long seed = from_environment("SANDGLASS_SEED", 1),
             periods = from_environment("SANDGLASS_PERIODS", 60);
  DynamicsSettings settings;
  settings.step_fraction = 0.01 * static_cast<double>(from_environment("SANDGLASS_PERCENT", 90));
  settings.body_frequency = static_cast<int>(from_environment("SANDGLASS_BODY_FREQUENCY", 0));
  for (long number = first; number < first + count; ++number) {
    const FreeMotion motion(seed, number);
    const Scene scene = motion.scene(static_cast<double>(periods), settings);
    const auto names = conservative_methods(scene);
    const auto method = std::string(names[static_cast<std::size_t>(number) % names.size()]);
    const bool single = number % 3 == 2;
    const Model model(
        scene,
        {.method = method, .precision = single ? Precision::single_precision : Precision::double_precision});
    Recorder recorder;
    const Motion end = integrate(model, recorder);
    const double start = total_energy(recorder.rows.front());
    double most = start, least = start;
    for (const HistoryRow& row : recorder.rows) {
      most = std::max(most, total_energy(row));
      least = std::min(least, total_energy(row));
    }
    const double gain = most / start - 1.0;
    if (count > 24) {
      fmt::print("{:4} {:24} {} nu {:6} strain {:.3f} elements {:3} gain {:7.3f} % loss {:7.3f} % steps {}\n",
                 number, method, single ? "float " : "double", motion.poisson_ratio(), motion.strain(),
                 scene.mesh.cells.size(), 100.0 * gain, 100.0 - 100.0 * least / start, end.steps);
    }
    EXPECT_LT(gain, 0.01) << "motion " << number << " of seed " << seed << ", " << method;
  }
}

}  // namespace
}  // namespace sandglass::verification::energy_test
