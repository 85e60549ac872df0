#include "stability/trial.hpp"

#include <fmt/format.h>

#include <cmath>

#include "assembly/method_entry.hpp"
#include "benchmark/own_motion.hpp"
#include "choice/variations.hpp"
#include "comparison/answer.hpp"
#include "comparison/comparison.hpp"
#include "io/case_file.hpp"

namespace sandglass {

namespace {

constexpr double careful_step = 0.5;
constexpr double usual_step = 0.9;

/// Shear waves, m/s.
double shear_wave_speed(const Case& description) {
  const double mu =
      std::visit([](const auto& law) { return law.shear_modulus(); }, description.materials.front().law);
  return std::sqrt(mu / description.materials.front().density);
}

double noise_velocity(const Trial& trial) {
  return trial.noise.value_or(0.0) * shear_wave_speed(trial.description);
}

}  // namespace

Scene scene_of(const Trial& trial) {
  CaseOnMesh problem = with_mesh(trial.description);
  auto& [description, mesh, sets, element_sets] = problem;
  const auto shape = [&](Vector& v) {
    v[2] *= trial.aspect;
    v[0] += trial.skew * v[2];
  };
  const auto on_boundary = boundary_nodes(mesh);
  for (const auto& rule : description.sets) sets[rule.name] = select_nodes(mesh, on_boundary, rule);
  for (const auto& rule : description.element_sets) element_sets[rule.name] = select_elements(mesh, rule);
  description.sets.clear();
  description.element_sets.clear();
  for (auto& X : mesh.points) shape(X);
  for (auto& displacement : description.displacements) shape(displacement.value);
  Scene scene = scaled(make_scene(description, std::move(mesh), std::move(sets), std::move(element_sets)),
                       trial.noise ? 0.0 : trial.load);
  if (!trial.is_dynamic()) return scene;
  scene = in_motion(std::move(scene));
  scene.settings.quasi_static = false;
  const double crossing = crossing_time(scene);
  scene.settings.dynamics = {.duration = (trial.noise ? 10.0 : 4.0) * crossing,
                             .ramp_time = 2.0 * crossing,
                             .step_fraction = trial.step.value_or(usual_step),
                             .damping = trial.noise ? 0.0 : 4.0 / crossing,
                             .frames = 1};
  if (trial.noise) {
    const double v = noise_velocity(trial);
    for (const int sign : zigzag(scene.mesh)) scene.initial_velocities.push_back({sign * v, 0.0, 0.0});
  }
  return scene;
}

double unit_of(const Trial& trial, const Scene& scene, const Displacements& golden) {
  if (trial.noise) return noise_velocity(trial) * scene.settings.dynamics.duration;
  return displacement_unit(scene, golden);
}

double limit_of(const Trial& trial, double limit) {
  return trial.noise ? 0.1 : limit;
}

Trial careful(Trial trial) {
  if (trial.is_dynamic()) trial.step = careful_step;
  return trial;
}

Trial golden_of(Trial trial) {
  trial.choice = {std::string(golden_method)};
  trial.description.relaxation.cycles = 0;
  for (Obstacle& obstacle : trial.description.forces.of<Obstacle>()) obstacle.penalty = Obstacle{}.penalty;
  return careful(std::move(trial));
}

std::string key_of(const Trial& trial) {
  const auto or_none = [](const std::optional<double>& value) {
    return value ? fmt::to_string(*value) : std::string("none");
  };
  const auto& [description, choice, load, aspect, skew, step, noise] = trial;
  return fmt::format("{} {} kappa {} {} load {} aspect {} skew {} step {} noise {} {}",
                     case_hash(description), choice.method, or_none(choice.kappa), name_of(choice.precision),
                     load, aspect, skew, or_none(step), or_none(noise), numerical_settings(description));
}

}  // namespace sandglass
